#include "onmesh/distance/make_backend.h"

#include "onmesh/distance/cloud/cloud.h"
#include "onmesh/distance/exact.h"
#include "onmesh/distance/heat/heat.h"
#include "onmesh/distance/unfold.h"

namespace onmesh {

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

}  // namespace onmesh
