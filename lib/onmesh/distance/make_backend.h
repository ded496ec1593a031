// Distance back ends by name.
#pragma once

#include <memory>

#include "onmesh/distance/backend.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// The back end of a method; `automatic` gives the virtual-source march. That of the exact method
/// throws InputError from fill() where the mesh is not manifold and wound consistently.
/// \pre the nodes lie on the mesh; for the exact method both outlive the back end
std::unique_ptr<DistanceBackend> make_backend(DistanceMethod method, const TriangleMesh& mesh,
                                              const NodeMesh& nodes);

}  // namespace onmesh
