// Triangles and segments by their corners or lengths: no mesh is needed for them.
#pragma once

#include <algorithm>
#include <array>

#include "onmesh/base/types.h"

namespace onmesh {

/// Area of a triangle from its side lengths, without cancellation (Kahan, "Miscalculating area and
/// angles of a needle-like triangle", 2014).
/// \return 0 if the lengths violate the triangle inequality
double triangle_area(double a, double b, double c);

/// The point with these barycentric coordinates; also the value there of what is linear between
/// the corners' values.
template <int N>
Eigen::Matrix<double, N, 1> interpolate(const std::array<Eigen::Matrix<double, N, 1>, 3>& corners,
                                        const Vec3& barycentric) {
  return barycentric[0] * corners[0] + barycentric[1] * corners[1] + barycentric[2] * corners[2];
}

/// Barycentric coordinates of p, which may lie outside; not finite if the triangle has no area.
Vec3 barycentric_in(const std::array<Vec2, 3>& triangle, const Vec2& p);

/// Barycentric coordinates of the point of the triangle that is closest to p. Slivers and triangles
/// without area will do.
Vec3 closest_barycentric(const std::array<Vec3, 3>& triangle, const Vec3& p);

/// Squared distance of p from the segment from a to b, which may be a point.
/// \param t if given, receives the place on the segment that is closest: 0 = a, 1 = b
template <int N>
double squared_distance_to_segment(const Eigen::Matrix<double, N, 1>& p,
                                   const Eigen::Matrix<double, N, 1>& a,
                                   const Eigen::Matrix<double, N, 1>& b, double* t = nullptr) {
  const Eigen::Matrix<double, N, 1> side = b - a;
  const double length2 = side.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(side) / length2, 0.0, 1.0) : 0.0;
  if (t != nullptr) *t = s;
  return (p - (a + s * side)).squaredNorm();
}

}  // namespace onmesh
