// How wrong distances are.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "onmesh/distance/backend.h"

namespace onmesh {

/// The back ends that comparisons show side by side.
inline constexpr std::array kComparedMethods{DistanceMethod::unfold, DistanceMethod::heat,
                                             DistanceMethod::cloud};

/// Errors over the points whose exact distance is known.
struct DistanceError {
  std::size_t points = 0;  ///< compared
  std::size_t missed = 0;  ///< with an exact distance, but no other
  std::size_t leaked = 0;  ///< with a distance although no way leads there
  double mean = 0;         ///< of |d - exact| over the points compared, mesh units
  double p99 = 0;          ///< its 99 % quantile, mesh units
  double max = 0;          ///< mesh units
  /// Error of the Gaussian weights g(d) = exp(-d^2 / 2 sigma^2): the sum of |g(d) - g(exact)| over
  /// the sum of g(exact), so the share of a kernel's weight that is wrong. Where no way leads, the
  /// weight is 0. NaN without a sigma.
  double weight = std::numeric_limits<double>::quiet_NaN();
};

/// Compare distances point by point. NaN = not known, infinity = no way leads there; an exact
/// distance that is not known leaves the point out, another's counts as none.
/// \param exact mesh units
/// \param other mesh units
/// \param sigma of the Gaussian weights, mesh units, > 0; infinity = none
/// \pre both have the same size
DistanceError distance_error(const std::vector<double>& exact, const std::vector<double>& other,
                             double sigma = std::numeric_limits<double>::infinity());

}  // namespace onmesh
