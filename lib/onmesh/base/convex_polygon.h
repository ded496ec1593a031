// A triangle of the plane cut down by lines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "onmesh/base/plane.h"

namespace onmesh {

/// What half-planes leave of a triangle (Sutherland and Hodgman 1974).
class ConvexPolygon {
 public:
  /// The whole triangle, its corners in either order.
  ConvexPolygon(const Vec2& a, const Vec2& b, const Vec2& c) : corners_{a, b, c}, size_(3) {}

  /// Keep what lies on the side of the line through `point` that `inward`, of any length but 0,
  /// points to.
  /// \pre at most seven calls: each adds a corner at most
  void clip(const Vec2& point, const Vec2& inward) {
    const auto depth = [&](const Vec2& p) { return inward.dot(p - point); };
    std::array<Vec2, kMost> kept;
    std::size_t size = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Vec2 &a = corners_[i], &b = corners_[(i + 1) % size_];
      const double da = depth(a), db = depth(b);
      if (da >= 0) kept[size++] = a;
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept[size++] = a + (b - a) * (da / (da - db));
    }
    corners_ = kept;
    size_ = size;
  }

  bool empty() const { return size_ == 0; }
  /// Lowest and highest coordinate.
  /// \param axis 0 = x, 1 = y
  /// \pre something is left
  std::pair<double, double> extent(int axis) const {
    std::pair<double, double> range{corners_[0][axis], corners_[0][axis]};
    for (std::size_t i = 1; i < size_; ++i) {
      range.first = std::min(range.first, corners_[i][axis]);
      range.second = std::max(range.second, corners_[i][axis]);
    }
    return range;
  }
  /// Not negative; 0 if nothing is left.
  double area() const {
    double twice = 0;
    for (std::size_t i = 0; i < size_; ++i) twice += cross(corners_[i], corners_[(i + 1) % size_]);
    return std::abs(twice) / 2;
  }
  /// Mean of the corners, which lies in the inside if there is one.
  /// \pre something is left
  Vec2 centre() const {
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = 0; i < size_; ++i) sum += corners_[i];
    return sum / double(size_);
  }

 private:
  static constexpr std::size_t kMost = 10;

  std::array<Vec2, kMost> corners_;
  std::size_t size_;
};

}  // namespace onmesh
