// The currency between refinement and what runs on it: nodes with their place on the input.
#pragma once

#include "onmesh/nodes/node_mesh.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// A node mesh made from an input mesh, with the way from one to the other.
struct NodeSurface {
  NodeMesh nodes;   ///< the nodes and the triangles between them
  Overlay overlay;  ///< where those lie on the input mesh
};

}  // namespace onmesh
