// Growing a patch from its core: what lies within reach.
#pragma once

#include <vector>

#include "onmesh/nodes/node_mesh.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

/// The core with every face that has a point within `reach` of a point of the core.
///
/// The region is grown by unfolding from the whole core at once, not along edges (edge paths
/// overestimate and would miss faces): Dijkstra's algorithm with the least of a point source's and
/// a straight front's distance across each face (the updates of Melvaer & Reimers 2012, see
/// distance/unfold.h, and of Kimmel & Sethian, Computing geodesic paths on manifolds, 1998). Costs
/// time and memory for the patch only, whatever the size of the mesh.
/// \param reach mesh units, >= 0
/// \pre mesh.build_incidence() was called; core faces are distinct
Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double reach);

/// The core with every face that tables need for pairs of points within `radius`, one in the core:
/// the corners of their faces are at most the nodes' extents farther apart, and the paths between
/// those stray little from the pairs'. Patch::extents is filled.
/// \param radius mesh units, >= 0
/// \param extents per node of the mesh: see edge_extents()
/// \pre mesh.build_incidence() was called; core faces are distinct; the mesh has no bridges
Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double radius,
                 const std::vector<double>& extents);

}  // namespace onmesh
