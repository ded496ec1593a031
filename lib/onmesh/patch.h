// Patches: bounded pieces of work, cut out of the node mesh.
#pragma once

#include <vector>

#include "onmesh/node_mesh.h"

namespace onmesh {

/// A group of core faces with its halo, as a complex of its own with local node numbers.
struct Patch {
  std::vector<Index> nodes;  ///< global node of each local node; the core's come first
  Index core_nodes = 0;      ///< how many of them are corners of core faces
  std::vector<Index> faces;  ///< global face of each local face; core faces come first
  Index core_faces = 0;
  std::vector<std::array<Index, 3>> corners;   ///< per local face: local nodes
  std::vector<std::array<double, 3>> lengths;  ///< per local face, as in NodeMesh
  double longest_edge = 0;
};

/// Group the faces that carry targets (weights > 0) into compact, connected groups of about
/// `target_weight`, deterministic; faces of weight 0 are in no group.
std::vector<std::vector<Index>> partition_faces(const NodeMesh& mesh,
                                                const std::vector<double>& weights,
                                                double target_weight);

/// The core with every face within `reach` of it. The region is grown by the unfolding march from
/// all core nodes at once, not along edges (edge paths overestimate and would miss nodes).
Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double reach);

}  // namespace onmesh
