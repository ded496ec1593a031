#include "support/exact_distances.h"

#include <memory>

#include "onmesh/measure/nearby_geodesics.h"

namespace onmesh {

Distances exact_distances(const TriangleMesh& mesh, double radius) {
  const auto geodesics = std::make_shared<NearbyGeodesics>(mesh, radius);
  return [geodesics](const SurfacePoint& source, const std::vector<SurfacePoint>& targets) {
    return geodesics->distances(source, targets);
  };
}

}  // namespace onmesh
