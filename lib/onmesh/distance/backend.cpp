#include "onmesh/distance/backend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr std::array<std::pair<DistanceMethod, std::string_view>, 5> kNames{{
    {DistanceMethod::automatic, "auto"},
    {DistanceMethod::unfold, "unfold"},
    {DistanceMethod::heat, "heat"},
    {DistanceMethod::cloud, "cloud"},
    {DistanceMethod::exact, "exact"},
}};

}  // namespace

std::string_view name_of(DistanceMethod method) {
  for (const auto& [value, name] : kNames)
    if (value == method) return name;
  return "?";
}

DistanceMethod distance_method(std::string_view name) {
  std::string known;
  for (const auto& [value, text] : kNames) {
    if (text == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw UsageError("unknown distance method '" + std::string(name) + "' (one of " + known + ")");
}

std::unique_ptr<DistanceBackend> make_backend(DistanceMethod method, const TriangleMesh& mesh,
                                              const NodeMesh& nodes) {
  switch (method) {
    case DistanceMethod::heat:
      return make_heat();
    case DistanceMethod::cloud:
      return make_cloud(mesh, nodes);
    case DistanceMethod::exact:
      return make_exact(mesh, nodes);
    case DistanceMethod::automatic:
    case DistanceMethod::unfold:
      break;
  }
  return make_unfold();
}

double barycentric_variance(const std::array<double, 3>& lengths, const Vec3& barycentric) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += barycentric[k] * barycentric[(k + 1) % 3] * lengths[k] * lengths[k];
  return sum;
}

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
