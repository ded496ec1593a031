// Points hashed into a uniform grid, for finding those near a place while more are added.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "onmesh/types.h"

namespace onmesh {

/// Numbers of points, by grid cell. The cells share buckets (hash without keys), so a query may
/// name points that are farther away, or one point twice: callers test the distance anyway.
class PointGrid {
 public:
  PointGrid() = default;
  /// \param origin no point is below it in any coordinate
  /// \param cell_size fastest when queries have about half of it as radius
  PointGrid(const Vec3& origin, double cell_size, std::size_t expected_points)
      : origin_(origin),
        cell_size_(cell_size),
        heads_(std::bit_ceil(std::max<std::size_t>(expected_points, 16)), kNone) {}

  /// Points are numbered in the order in which they are inserted, from 0.
  void insert(const Vec3& point) {
    Index& head = heads_[bucket(cell(point))];
    next_.push_back(head);
    head = Index(next_.size() - 1);
  }

  /// Call visit(number) for all points within the radius (and some more) until it returns true.
  /// \return whether it did
  template <typename Visit>
  bool visit(const Vec3& centre, double radius, const Visit& visit) const {
    const Cell low = cell((centre.array() - radius).matrix());
    const Cell high = cell((centre.array() + radius).matrix());
    for (std::int64_t z = low[2]; z <= high[2]; ++z)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
          for (Index i = heads_[bucket({x, y, z})]; i != kNone; i = next_[i])
            if (visit(i)) return true;
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell(const Vec3& p) const {
    Cell c;
    for (int k = 0; k < 3; ++k)
      c[std::size_t(k)] = std::int64_t(std::floor((p[k] - origin_[k]) / cell_size_));
    return c;
  }
  // Cells of a 4 x 4 x 4 block are neighbours in memory.
  std::size_t bucket(const Cell& c) const {
    std::uint64_t h = std::uint64_t(c[0] >> 2) * 0x9e3779b97f4a7c15U;
    h = (std::rotl(h, 29) ^ std::uint64_t(c[1] >> 2)) * 0xbf58476d1ce4e5b9U;
    h = (std::rotl(h, 29) ^ std::uint64_t(c[2] >> 2)) * 0x94d049bb133111ebU;
    h = (h >> 32) << 6 | std::uint64_t((c[2] & 3) << 4 | (c[1] & 3) << 2 | (c[0] & 3));
    return std::size_t(h) & (heads_.size() - 1);
  }

  Vec3 origin_ = Vec3::Zero();
  double cell_size_ = 1;
  std::vector<Index> heads_;  // per bucket, the last point inserted
  std::vector<Index> next_;   // per point, the one inserted before it
};

}  // namespace onmesh
