// Patches: bounded pieces of work, cut out of the node mesh. partition.h chooses their cores,
// grow_patch.h makes them.
#pragma once

#include <array>
#include <vector>

#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// A group of core faces with its halo, as a complex of its own with local node numbers. Lengths
/// are mesh units.
struct Patch {
  std::vector<Index> nodes;  ///< global node of each local node; the core's come first
  Index core_nodes = 0;      ///< how many of them are corners of core faces
  std::vector<Index> faces;  ///< global face of each local face; core faces come first
  Index core_faces = 0;      ///< how many of them are core faces
  std::vector<std::array<Index, 3>> corners;     ///< per local face: local nodes
  std::vector<std::array<double, 3>> lengths;    ///< per local face, as in NodeMesh
  std::vector<std::array<Index, 3>> neighbours;  ///< as in NodeMesh with local faces; kNone outside
  double longest_edge = 0;                       ///< of its faces
  /// Per local node: see edge_extents(). Empty if the patch was grown to the same reach everywhere.
  std::vector<double> extents;
  Index bridge_faces = 0;  ///< so many of the last faces are bridges, as in NodeMesh
};

}  // namespace onmesh
