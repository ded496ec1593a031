// Points hashed into uniform grids, for finding those near a place while more are added (internal).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// Points with a spacing of their own, in grids whose cells double in size from level to level.
///
/// A place with spacing r is looked up in the grid of that spacing's level, and a point is in the
/// grids of all levels that its spacing differs from by at most a factor. The cells share buckets
/// (hash without keys), so a query may name points that are farther away, or one point twice:
/// callers test the distance anyway.
class PointGrid {
 public:
  struct Entry {
    Vec3 position;
    double spacing;
    Index number, label, next;
  };

  PointGrid() = default;
  /// \param origin no point is below it in any coordinate
  /// \param least, largest spacings are in this range (others count as its ends)
  /// \param factor >= 1: how much the spacings at two places may differ that are to find each other
  PointGrid(const Vec3& origin, double least, double largest, double factor,
            std::size_t expected_points)
      : origin_(origin),
        least_(least),
        largest_(largest),
        factor_(factor),
        levels_(exponent(largest / least) + 1),
        heads_(std::bit_ceil(std::max<std::size_t>(expected_points, 16)), kNone) {
    for (int l = 0; l < levels_; ++l) scales_.push_back(std::ldexp(1 / (kCellSize * least_), -l));
    entries_.reserve(expected_points);
  }

  /// \param label comes back with the entry
  void insert(Index number, Index label, const Vec3& position, double spacing) {
    const int last = level(spacing * factor_);
    for (int l = level(spacing / factor_); l <= last; ++l) {
      Index& head = heads_[bucket(cell(position, l), l)];
      entries_.push_back({position, spacing, number, label, head});
      head = Index(entries_.size() - 1);
    }
  }

  /// Call visit(entry) for all points within the radius (and some more) of a place whose spacing is
  /// in [low, high], until it returns true. Fastest when the radius is one or two spacings.
  /// \pre radius <= 6 low
  /// \return whether it did
  template <typename Visit>
  bool visit(const Vec3& centre, double low, double high, double radius, const Visit& visit) const {
    const int last = level(high);
    for (int l = level(low); l <= last; ++l) {
      const Cell from = cell((centre.array() - radius).matrix(), l);
      const Cell to = cell((centre.array() + radius).matrix(), l);
      for (std::int64_t z = from[2]; z <= to[2]; ++z)
        for (std::int64_t y = from[1]; y <= to[1]; ++y)
          for (std::int64_t x = from[0]; x <= to[0]; ++x)
            for (Index i = heads_[bucket({x, y, z}, l)]; i != kNone; i = entries_[i].next)
              if (visit(entries_[i])) return true;
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr double kCellSize = 3.2;  // in spacings of the level's finest

  /// Number of times that the spacing halves down to the least, 0 for the finest grid.
  int level(double spacing) const {
    if (levels_ == 1) return 0;
    return exponent(std::clamp(spacing, least_, largest_) / least_);
  }
  static int exponent(double ratio) {
    return int(std::bit_cast<std::uint64_t>(ratio) >> 52) - 1023;
  }
  Cell cell(const Vec3& p, int level) const {
    const double scale = scales_[std::size_t(level)];
    Cell c;
    // What is not below -2 is truncated like the rest.
    for (int k = 0; k < 3; ++k) c[std::size_t(k)] = std::int64_t((p[k] - origin_[k]) * scale + 2);
    return c;
  }
  // Cells of a 4 x 4 x 4 block are neighbours in memory.
  std::size_t bucket(const Cell& c, int level) const {
    std::uint64_t h = (std::uint64_t(c[0] >> 2) + std::uint64_t(level)) * 0x9e3779b97f4a7c15U;
    h = (std::rotl(h, 29) ^ std::uint64_t(c[1] >> 2)) * 0xbf58476d1ce4e5b9U;
    h = (std::rotl(h, 29) ^ std::uint64_t(c[2] >> 2)) * 0x94d049bb133111ebU;
    h = (h >> 32) << 6 | std::uint64_t((c[2] & 3) << 4 | (c[1] & 3) << 2 | (c[0] & 3));
    return std::size_t(h) & (heads_.size() - 1);
  }

  Vec3 origin_ = Vec3::Zero();
  double least_ = 1, largest_ = 1, factor_ = 1;
  int levels_ = 0;
  std::vector<double> scales_;  // cells per unit of length, by level
  std::vector<Index> heads_;    // per bucket, the last entry
  std::vector<Entry> entries_;  // each with the one inserted before it in its bucket
};

}  // namespace onmesh
