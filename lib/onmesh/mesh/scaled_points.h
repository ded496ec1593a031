// Positions at a size whose squares hold, with how far each may be off (internal).
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// The positions of a mesh times a power of two that brings the largest coordinate near 1.
struct ScaledPoints {
  std::vector<Vec3> points;
  std::vector<double> tolerance;  ///< per point
  double largest_tolerance = 0;

  /// \param given as join_boundaries() takes it
  ScaledPoints(const TriangleMesh& mesh, std::optional<double> given);

  std::array<Vec3, 3> corners(const std::array<Index, 3>& face) const {
    return {points[face[0]], points[face[1]], points[face[2]]};
  }
  double length(const std::array<Index, 2>& ends) const {
    return (points[ends[1]] - points[ends[0]]).norm();
  }
  /// The larger tolerance of an edge's ends: a coordinate near 0 may come from larger ones.
  double tolerance_along(const std::array<Index, 2>& ends) const {
    return std::max(tolerance[ends[0]], tolerance[ends[1]]);
  }
  bool within(Index a, Index b, double t) const {
    return (points[a] - points[b]).squaredNorm() <= t * t;
  }
  /// How far around a place to look for what may be within the tolerance, or within the cap.
  double reach(double cap) const {
    constexpr double kRounding = 1e-14;  // of the look-up, beside coordinates near 1
    return std::min(largest_tolerance, cap) + kRounding;
  }
};

/// The tolerance is at most this share of an edge, which can then not collapse.
inline constexpr double kMostOfAnEdge = 1.0 / 8;

}  // namespace onmesh
