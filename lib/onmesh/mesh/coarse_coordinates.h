// Meshes whose coordinates were stored too coarsely for their edges.
#pragma once

#include <string>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What rounding took from a mesh.
struct CoarseCoordinates {
  Index collapsed = 0;  ///< faces with corners that became one, though the file tells them apart
  std::string problem;  ///< one line with lengths in mesh units; empty if nothing is lost
};

/// Find out whether the steps in which coordinates were stored are larger than the edges allow, as
/// 32-bit floats far from the origin are.
/// \param welded what weld() made of the mesh as read
CoarseCoordinates find_coarse_coordinates(const TriangleMesh& as_read, const TriangleMesh& welded);

}  // namespace onmesh
