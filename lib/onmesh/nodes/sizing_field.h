// How fine nodes should be at the vertices of any triangle complex (internal: refine).
#pragma once

#include <vector>

#include "onmesh/mesh/edge_table.h"
#include "onmesh/nodes/refine.h"

namespace onmesh {

/// The wanted spacing per vertex, mesh units: options.spacing where the surface is flat, less where
/// it is curved and where distances bend, growing away from there along the mesh's edges.
std::vector<double> wanted_spacing(const TriangleMesh& mesh, const EdgeTable& edges,
                                   const RefineOptions& options);

}  // namespace onmesh
