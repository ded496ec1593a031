// Which way round the faces of a mesh run.
#pragma once

#include <vector>

#include "onmesh/mesh/edge_table.h"

namespace onmesh {

/// Which faces to turn over so that the two faces of every edge run along it in opposite
/// directions.
struct Winding {
  std::vector<bool> flip;  ///< per face
  Index conflict = kNone;  ///< a face of a component that cannot be wound; kNone = all can
};

/// The smaller area of every component (over edges with two faces) is what is turned over; nothing
/// of a component that cannot be wound.
/// \param edges of the mesh
Winding consistent_winding(const TriangleMesh& mesh, const EdgeTable& edges);

}  // namespace onmesh
