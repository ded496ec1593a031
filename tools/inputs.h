// What several subcommands take: meshes made ready, textures or resolutions, wrap modes, outputs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/filter/length.h"
#include "onmesh/image/image.h"
#include "onmesh/mesh/clean.h"

namespace onmesh::tools {

/// A mesh file and what filtering makes of it.
struct InputMesh {
  std::string path;
  TriangleMesh as_read, welded;  ///< the same faces in the same order
  TriangleMesh cleaned;          ///< as clean() leaves it
  CleanReport cleaning;
  std::vector<std::string> warnings;
};

/// \throw FileError, InputError as read_mesh()
InputMesh read_input_mesh(const std::string& path);

/// Calls work(); an InputError that names neither the file nor an option gets the file in front.
template <class Work>
auto naming(const std::string& path, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool named = message.rfind("--", 0) == 0 || message.find(path) != std::string::npos;
    throw InputError(named ? message : path + ": " + message);
  }
}

/// The images that the materials of textured faces name, each once, in the order of the materials.
std::vector<std::string> named_textures(const TriangleMesh& mesh);
/// For every face whether its material names this texture and it has UVs.
std::vector<bool> faces_with_texture(const TriangleMesh& mesh, const std::string& texture);

/// Adds --texture, --resolution, --material and --wrap.
void add_atlas_options(po::options_description& options);

/// The size of the texture whose atlas is meant, and the faces that carry it.
struct Atlas {
  int width = 0, height = 0;
  std::string texture;  ///< path; empty if a resolution was given
  Image image;          ///< empty if a resolution was given
  TexelMapOptions map;
};

bool has_atlas_option(const po::variables_map& values);
/// --resolution WxH, or the size of --texture; without either that of the texture that the mesh's
/// materials name. Faces are chosen as by filter: see choose_texture().
/// \param texture the option's name where --texture is something else
/// \throw UsageError if both are given, or several textures could be meant
Atlas read_atlas(const po::variables_map& values, const TriangleMesh& mesh,
                 const std::string& texture = "texture");
std::optional<std::string> optional_text(const po::variables_map& values, const std::string& name);
/// The values of --wrap.
Wrap wrap_of(const po::variables_map& values);

/// \throw FileError if a file cannot be written there later
void check_writable_file(const std::string& path);

/// ".exr", also for "A.EXR".
std::string lower_extension(const std::string& path);

/// The length that --bridge gives, nothing for none (0, the default).
std::optional<Length> bridge_of(const po::variables_map& values);

/// "%.6g", the way numbers are printed for people.
std::string format_number(double value);

}  // namespace onmesh::tools
