#include "onmesh/distance/distance_table.h"

#include <algorithm>
#include <cmath>

namespace onmesh {

double interpolate_squared(const double (&squared)[3][3], const Vec3& a, const Vec3& b,
                           double variance_a, double variance_b) {
  double sum = -variance_a - variance_b;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (a[i] == 0 || b[j] == 0) continue;
      if (squared[i][j] >= double(kUnreachable)) return double(kUnreachable);
      sum += a[i] * b[j] * squared[i][j];
    }
  return std::max(sum, 0.0);
}

double barycentric_variance(const std::array<double, 3>& lengths, const Vec3& barycentric) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += barycentric[k] * barycentric[(k + 1) % 3] * lengths[k] * lengths[k];
  return sum;
}

std::vector<double> distances_from(const Patch& patch, const DistanceTable& table, Index core_face,
                                   const Vec3& barycentric) {
  const double variance = barycentric_variance(patch.lengths[core_face], barycentric);
  std::vector<double> squared(table.columns, -variance);
  for (int k = 0; k < 3; ++k) {
    if (barycentric[k] == 0) continue;
    const float* row = table.row(patch.corners[core_face][k]);
    for (Index j = 0; j < table.columns; ++j)
      squared[j] += row[j] == kUnreachable ? std::numeric_limits<double>::infinity()
                                           : barycentric[k] * row[j];
  }
  for (double& d : squared) d = std::sqrt(std::max(d, 0.0));
  return squared;
}

}  // namespace onmesh
