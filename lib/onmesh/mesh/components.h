// Connected components of a mesh.
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Parts of a mesh that share no vertex, numbered from 0 in the order of their first faces.
struct FaceComponents {
  std::vector<Index> of_face;
  Index count = 0;
};

/// The components of a mesh: faces that share a vertex are in the same one.
/// \pre mesh is welded, else every seam and every loose triangle parts it
FaceComponents connected_components(const TriangleMesh& mesh);

}  // namespace onmesh
