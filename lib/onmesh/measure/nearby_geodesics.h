// Exact distances to tell other distances' errors by.
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// Exact distances up to a radius. The exact algorithm knows no radius, so the mesh is cut down to
/// what paths of that length can touch, anew for each source. Queries may run in parallel.
class NearbyGeodesics {
 public:
  /// \param radius mesh units, > 0; may be infinite
  /// \pre mesh outlives this
  NearbyGeodesics(const TriangleMesh& mesh, double radius);
  /// Distances in mesh units, NaN beyond the radius and where no way leads.
  /// \throw InputError if the mesh is not manifold near the source
  std::vector<double> distances(const SurfacePoint& source,
                                const std::vector<SurfacePoint>& targets) const;

 private:
  const TriangleMesh& mesh_;
  double radius_;
  NodeMesh complex_;
};

}  // namespace onmesh
