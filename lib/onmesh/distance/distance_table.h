// Tables of squared distances between nodes, and distances between any two points by them.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "onmesh/base/types.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

/// Table entry of a node that is farther than asked for, or not reachable: weight 0, no arithmetic.
inline constexpr float kUnreachable = std::numeric_limits<float>::max();

/// Squared geodesic distances, core nodes x patch nodes, row-major; square mesh units, or
/// kUnreachable.
struct DistanceTable {
  Index rows = 0;              ///< core nodes
  Index columns = 0;           ///< nodes of the patch
  std::vector<float> squared;  ///< rows * columns
  /// The distances from core node i.
  const float* row(Index i) const { return squared.data() + std::size_t(i) * columns; }
};

/// Squared distance between two points x and y of node faces from nine table entries:
///
///     d^2(x, y) = sum_ij a_i b_j D_ij - V(x) - V(y), clamped at 0,
///
/// the formula at the heart of the filter, derived in lib/README.md. It is exact where a plane, or
/// what unfolds into one, holds both faces.
/// \param squared D_ij: entries for corner i of x's face and corner j of y's
/// \param a barycentric coordinates of x
/// \param b barycentric coordinates of y
/// \param variance_a V(x), see barycentric_variance()
/// \param variance_b V(y)
/// \return kUnreachable if an entry that takes part is
double interpolate_squared(const double (&squared)[3][3], const Vec3& a, const Vec3& b,
                           double variance_a, double variance_b);

/// The barycentric variance of a point in its face, V(x) = a0 a1 l01^2 + a1 a2 l12^2 + a2 a0 l20^2:
/// the mean squared distance of the corners from it, weighted by its coordinates.
/// \param lengths of the face, as in NodeMesh
/// \return square mesh units
double barycentric_variance(const std::array<double, 3>& lengths, const Vec3& barycentric);

/// Distances from a point x of a core face to every node of the patch, from the table:
/// d^2 = sum_i a_i D_ij - V(x), which is interpolate_squared() where y is a node.
/// \param core_face local index
/// \return mesh units, per node; infinity where a corner with a_i != 0 did not reach the node
std::vector<double> distances_from(const Patch& patch, const DistanceTable& table, Index core_face,
                                   const Vec3& barycentric);

}  // namespace onmesh
