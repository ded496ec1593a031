// Which pairs of points are within the radius.
#pragma once

#include <cmath>

namespace onmesh {

/// A pair counts if d^2 <= radius^2 * kRadiusSlack (dimensionless). On regular grids many pairs tie
/// at the radius; rounding must not decide about them.
inline constexpr double kRadiusSlack = 1 + 1e-5;

/// \return the largest squared distance of a pair within the radius
constexpr double largest_squared(double radius) { return radius * radius * kRadiusSlack; }

/// \return the largest distance of a pair within the radius
inline double largest_distance(double radius) { return radius * std::sqrt(kRadiusSlack); }

}  // namespace onmesh
