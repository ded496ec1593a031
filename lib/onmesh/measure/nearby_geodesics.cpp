#include "onmesh/measure/nearby_geodesics.h"

#include <cmath>

#include "onmesh/base/face_error.h"
#include "onmesh/distance/exact.h"
#include "onmesh/patches/grow_patch.h"

namespace onmesh {

NearbyGeodesics::NearbyGeodesics(const TriangleMesh& mesh, double radius)
    : mesh_(mesh), radius_(radius), complex_(make_node_mesh(mesh)) {}

std::vector<double> NearbyGeodesics::distances(const SurfacePoint& source,
                                               const std::vector<SurfacePoint>& targets) const {
  std::vector<bool> keep(mesh_.faces.size(), false);
  for (const Index f : grow_patch(complex_, {source.face}, radius_).faces) keep[f] = true;
  std::vector<Index> number(mesh_.faces.size(), kNone), kept;
  for (Index f = 0; f < keep.size(); ++f) {
    if (!keep[f]) continue;
    number[f] = Index(kept.size());
    kept.push_back(f);
  }
  std::vector<SurfacePoint> inside;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (number[targets[i].face] == kNone) continue;
    inside.push_back({number[targets[i].face], targets[i].barycentric});
    which.push_back(i);
  }
  const std::vector<double> found = with_face_numbers(kept, [&] {
    ExactGeodesics geodesics(extract_faces(mesh_, keep));
    return geodesics.distances({number[source.face], source.barycentric}, inside);
  });
  std::vector<double> distances(targets.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (found[i] <= radius_ && std::isfinite(found[i])) distances[which[i]] = found[i];
  }
  return distances;
}

}  // namespace onmesh
