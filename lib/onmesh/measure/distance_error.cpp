#include "onmesh/measure/distance_error.h"
#include "onmesh/distance/exact.h"
#include "onmesh/patches/grow_patch.h"

#include <algorithm>
#include <cmath>

namespace onmesh {

DistanceError distance_error(const std::vector<double>& exact, const std::vector<double>& other,
                             double sigma) {
  DistanceError result;
  std::vector<double> errors;
  double weights = 0, wrong = 0;
  const auto weight = [sigma](double d) { return std::exp(-d * d / (2 * sigma * sigma)); };
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::isnan(exact[i])) continue;
    const bool exists = std::isfinite(exact[i]), known = std::isfinite(other[i]);
    const double right = exists ? weight(exact[i]) : 0;
    weights += right;
    wrong += std::abs(right - (known ? weight(other[i]) : 0));
    if (exists && known) errors.push_back(std::abs(exact[i] - other[i]));
    if (exists && !known) ++result.missed;
    if (!exists && known) ++result.leaked;
  }
  if (std::isfinite(sigma) && weights > 0) result.weight = wrong / weights;
  result.points = errors.size();
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  for (const double e : errors) result.mean += e / double(errors.size());
  result.p99 = errors[std::size_t(std::ceil(0.99 * double(errors.size()))) - 1];
  result.max = errors.back();
  return result;
}

}  // namespace onmesh
