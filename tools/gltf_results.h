// Results that go into a glTF file: the one that was read, with other images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "output_names.h"
#include "texture_set.h"

namespace onmesh::tools {

/// The outputs of a set whose results go into a glTF file.
/// \param meshes as read, with the materials' textures of all slots
/// \throw UsageError if the mesh is none of that kind, or the textures are not its own
/// \throw FileError if the file cannot be written
OutputNames name_gltf_outputs(const TextureSet& set, const std::vector<const TriangleMesh*>& meshes,
                              const std::string& mesh_path, const std::string& output);

/// Write the results that changed in the place of the images they were made of. An image without a
/// changed texel keeps its bytes.
/// \param before the images as they were read, per texture of the set
/// \param after the results
/// \param warnings receives what was encoded again with loss, and which files came beside
void write_into_gltf(const std::string& output, const std::string& mesh_path, const TextureSet& set,
                     const std::vector<Image>& before, const std::vector<Image>& after,
                     std::vector<std::string>& warnings);

}  // namespace onmesh::tools
