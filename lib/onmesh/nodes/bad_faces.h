// The faces that a refinement has yet to make better, in the order to take them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// Bad faces by what is to be done first. Within a class the one that came last goes first: so the
/// refinement works its way from place to place, in memory that is still in the cache, and new
/// nodes are neighbours of the ones before.
class BadFaces {
 public:
  static constexpr int kNotBad = -1;
  static constexpr int kFront = 0;
  static constexpr int kClasses = 64;
  static constexpr int kThin = kClasses - 1;
  static constexpr double kLargestSize = double(std::uint64_t{1} << (kThin - 2));  ///< squared
  /// The class of a large face that is not at the front: the smallest come first, so that one place
  /// is refined until a front starts from there.
  /// \param size circumradius as a share of the largest one allowed, > 1
  static int large(double size) { return 1 + std::ilogb(std::min(size * size, kLargestSize)); }

  void push(Index face, int face_class) {
    classes_[std::size_t(face_class)].push_back(face);
    first_ = std::min(first_, face_class);
  }
  /// \return false if there are none left
  bool pop(Index& face, int& face_class) {
    while (first_ < kClasses && classes_[std::size_t(first_)].empty()) ++first_;
    if (first_ == kClasses) return false;
    face_class = first_;
    face = classes_[std::size_t(first_)].back();
    classes_[std::size_t(first_)].pop_back();
    return true;
  }

 private:
  std::array<std::vector<Index>, kClasses> classes_;
  int first_ = kClasses;
};

}  // namespace onmesh
