// Patches: bounded pieces of work, cut out of the node mesh.
#pragma once

#include <vector>

#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// A group of core faces with its halo, as a complex of its own with local node numbers.
struct Patch {
  std::vector<Index> nodes;  ///< global node of each local node; the core's come first
  Index core_nodes = 0;      ///< how many of them are corners of core faces
  std::vector<Index> faces;  ///< global face of each local face; core faces come first
  Index core_faces = 0;
  std::vector<std::array<Index, 3>> corners;     ///< per local face: local nodes
  std::vector<std::array<double, 3>> lengths;    ///< per local face, as in NodeMesh
  std::vector<std::array<Index, 3>> neighbours;  ///< as in NodeMesh with local faces; kNone outside
  double longest_edge = 0;
  /// Per local node: see edge_extents(). Empty if the patch was grown to the same reach everywhere.
  std::vector<double> extents;
  Index bridge_faces = 0;  ///< so many of the last faces are bridges, as in NodeMesh
};

/// Group the faces that carry targets (weights > 0) into compact groups of about `target_weight`
/// (at most 1.5 times that unless a face alone weighs more), each connected over shared nodes;
/// faces of weight 0 are in no group. Deterministic; faces ascend within a group; O(faces log
/// groups), in partition.cpp. \pre mesh.build_incidence() was called, one weight per face,
/// target_weight > 0
std::vector<std::vector<Index>> partition_faces(const NodeMesh& mesh,
                                                const std::vector<double>& weights,
                                                double target_weight);

/// The core with every face that has a point within `reach` of a point of the core. The region is
/// grown by unfolding from the whole core at once, not along edges (edge paths overestimate and
/// would miss faces). Costs time and memory for the patch only, whatever the size of the mesh. \pre
/// mesh.build_incidence() was called; core faces are distinct
Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double reach);

/// How long the edges near each node are: the longest around it, or around another node less a
/// seventh of the distance to that along edges. Edges lead up to 2.4 times as far around as the
/// surface (past angles of 130 degrees), so extents change by about a third of the distance at
/// most. \pre mesh.build_incidence() was called
std::vector<double> edge_extents(const NodeMesh& mesh);

/// The core with every face that tables need for pairs of points within `radius`, one in the core:
/// the corners of their faces are at most the nodes' extents farther apart, and the paths between
/// those stray little from the pairs'. Patch::extents is filled. \pre as above; no bridges
Patch grow_patch(const NodeMesh& mesh, const std::vector<Index>& core_faces, double radius,
                 const std::vector<double>& extents);

/// Number of the edge k of every face. Edges are identified by the gluing where the patch knows it,
/// else by their nodes and lengths: that also joins edges of three or more faces.
std::vector<std::array<Index, 3>> number_edges(const Patch& patch, Index& count);

}  // namespace onmesh
