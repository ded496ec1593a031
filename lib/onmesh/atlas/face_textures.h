// Which texture each face looks up (internal).
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct FaceTextures {
  std::vector<Index> of_face;  ///< number of the texture, per face
  Index count = 0;
};

/// Number the textures that the faces' materials name. All faces without one share a number: they
/// look up whatever texture is chosen for them.
/// \param by_wrap number those apart that read one texture in different wrap modes
FaceTextures number_textures(const TriangleMesh& mesh, bool by_wrap = false);

}  // namespace onmesh
