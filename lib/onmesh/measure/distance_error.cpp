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

NearbyGeodesics::NearbyGeodesics(const TriangleMesh& mesh, double radius)
    : mesh_(mesh), radius_(radius), complex_(make_node_mesh(mesh)) {}

std::vector<double> NearbyGeodesics::distances(const SurfacePoint& source,
                                               const std::vector<SurfacePoint>& targets) const {
  std::vector<bool> keep(mesh_.faces.size(), false);
  for (const Index f : grow_patch(complex_, {source.face}, radius_).faces) keep[f] = true;
  std::vector<Index> number(mesh_.faces.size(), kNone);
  Index count = 0;
  for (Index f = 0; f < keep.size(); ++f) {
    if (keep[f]) number[f] = count++;
  }
  std::vector<SurfacePoint> inside;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (number[targets[i].face] == kNone) continue;
    inside.push_back({number[targets[i].face], targets[i].barycentric});
    which.push_back(i);
  }
  ExactGeodesics geodesics(extract_faces(mesh_, keep));
  const std::vector<double> found =
      geodesics.distances({number[source.face], source.barycentric}, inside);
  std::vector<double> distances(targets.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (found[i] <= radius_ && std::isfinite(found[i])) distances[which[i]] = found[i];
  }
  return distances;
}

}  // namespace onmesh
