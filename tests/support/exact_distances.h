// CGAL's exact geodesic distances, as the oracle takes them.
#pragma once

#include "onmesh/mesh/triangle_mesh.h"
#include "support/distances.h"

namespace onmesh {

/// NaN beyond `radius` (mesh units): what is nearer is found without the rest of the mesh.
/// \pre the mesh is manifold and wound consistently
Distances exact_distances(const TriangleMesh& mesh, double radius);

}  // namespace onmesh
