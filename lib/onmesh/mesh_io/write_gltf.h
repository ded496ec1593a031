// Writing glTF files with other images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace onmesh {

/// An image of a glTF file with other content.
struct GltfImage {
  std::string texture;  ///< as Material::texture has it
  std::string content;  ///< of an image file of the same format
};

/// Whether a file name is that of a glTF file: .gltf or .glb, in any case.
bool is_gltf_name(const std::filesystem::path& path);

/// Write a glTF file again with other images; all else stays: geometry byte for byte, the JSON
/// but for images, buffer views and what they lie in. Images inside the file stay inside. Those
/// in files of their own, and buffers that changed, are written beside the new file; in the
/// same folder they get its name in front, so that no file of the old one is written over. In
/// another folder all that the file names is copied there.
/// \param path where to, with the extension of `source`
/// \param source the file as it was read
/// \param images those that changed; others keep their bytes
/// \return the files that were written beside it
/// \throw FileError if something cannot be written; then nothing is
/// \throw InputError as read_mesh(), or if an image is none of the file's, or naming the path
///   if it is `source` or has another extension
std::vector<std::filesystem::path> write_gltf(const std::filesystem::path& path,
                                              const std::filesystem::path& source,
                                              const std::vector<GltfImage>& images);

}  // namespace onmesh
