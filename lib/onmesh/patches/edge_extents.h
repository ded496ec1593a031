// How far the edges around each node of a graded node mesh reach.
#pragma once

#include <vector>

#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// How long the edges near each node are: the longest around it, or around another node less a
/// seventh of the distance to that along edges. Edges lead up to 2.4 times as far around as the
/// surface (past angles of 130 degrees), so extents change by about a third of the distance at
/// most.
/// \pre mesh.build_incidence() was called
/// \return mesh units, per node
std::vector<double> edge_extents(const NodeMesh& mesh);

}  // namespace onmesh
