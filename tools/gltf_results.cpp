#include "gltf_results.h"

#include <algorithm>
#include <system_error>

#include "inputs.h"
#include "interruption.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_gltf.h"

namespace onmesh::tools {

namespace fs = std::filesystem;

OutputNames name_gltf_outputs(const TextureSet& set, const std::vector<const TriangleMesh*>& meshes,
                              const std::string& mesh_path, const std::string& output) {
  const auto extension = [](const std::string& path) {
    return lower_case(fs::path(path).extension().string());
  };
  if (!is_gltf_name(mesh_path)) {
    throw UsageError("--output: " + output + " is a glTF file, and " + mesh_path +
                     " is none; name an image");
  }
  if (extension(mesh_path) != extension(output)) {
    throw UsageError("--output: a " + extension(mesh_path) + " is written as it was read, with " +
                     extension(mesh_path) + " at the end");
  }
  std::error_code none;
  if (fs::equivalent(mesh_path, output, none))
    throw UsageError("--output: " + output + " is the mesh");
  OutputNames names;
  names.paths.resize(set.textures.size());
  for (std::size_t i = 0; i < set.textures.size(); ++i) {
    const SetTexture& texture = set.textures[i];
    if (!texture.is_written) continue;
    const bool is_own = std::any_of(meshes.begin(), meshes.end(), [&](const TriangleMesh* mesh) {
      return std::any_of(
          mesh->materials.begin(), mesh->materials.end(),
          [&](const Material& material) { return texture.path == fs::path(material.texture); });
    });
    if (!is_own) {
      throw UsageError("--output: " + texture.path.string() + " is no image of " + mesh_path +
                       "; without -t its own are filtered, and -o may name an image");
    }
    names.paths[i] = output;
  }
  check_writable_file(output);
  return names;
}

void write_into_gltf(const std::string& output, const std::string& mesh_path, const TextureSet& set,
                     const std::vector<Image>& before, const std::vector<Image>& after,
                     std::vector<std::string>& warnings) {
  std::vector<GltfImage> images;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const SetTexture& texture = set.textures[i];
    if (!texture.is_written || has_same_pixels(before[i], after[i])) continue;
    check_interrupted();
    images.push_back({texture.path.string(), encode_image(texture.path, after[i], {}, &warnings)});
    const std::string extension = lower_case(texture.path.extension().string());
    if (extension == ".jpg" || extension == ".jpeg")
      warnings.push_back(texture.path.string() +
                         ": is encoded as JPEG again, which loses a little");
  }
  const std::vector<fs::path> beside = write_gltf(output, mesh_path, images);
  for (const fs::path& file : beside)
    warnings.push_back(output + ": " + file.string() + " was written beside it");
}

}  // namespace onmesh::tools
