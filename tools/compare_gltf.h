// What compare makes of two glTF files.
#pragma once

#include <vector>

#include "arguments.h"
#include "inputs.h"
#include "texture_set.h"

namespace onmesh::tools {

/// The images that two glTF files have for a slot, pair by pair, and the mesh that wears them.
struct GltfPairs {
  InputMesh mesh;                ///< that of --mesh, else of A
  TextureSet set;                ///< of the mesh's materials
  std::vector<SetTexture> a, b;  ///< per texture of the set
};

/// \param arguments A and B are glTF files
/// \throw InputError if the files have other numbers of images, or other names for them;
///   UsageError if the mesh wears others
GltfPairs pair_gltf_images(const Arguments& arguments);

}  // namespace onmesh::tools
