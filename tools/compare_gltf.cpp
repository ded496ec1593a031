#include "compare_gltf.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "messages.h"
#include "onmesh/base/text.h"

namespace onmesh::tools {
namespace {

namespace fs = std::filesystem;

/// A file's textures by what they are called in it.
using NamedTextures = std::map<std::string, SetTexture>;

TextureSet textures_worn(const TriangleMesh& mesh, const Arguments& arguments) {
  TextureSet set = choose_textures(mesh, {{}, arguments.optional_text("material"), {}});
  keep_written(set);
  return set;
}

/// From the file if they are inside, else from its folder.
std::string name_in(const std::string& file, const SetTexture& texture) {
  const fs::path from = texture.content ? fs::path(file) : fs::path(file).parent_path();
  return texture.path.lexically_relative(from).string();
}

NamedTextures named_textures(const std::string& file, const TriangleMesh& mesh,
                             const Arguments& arguments) {
  NamedTextures named;
  for (const SetTexture& texture : textures_worn(mesh, arguments).textures)
    named.emplace(name_in(file, texture), texture);
  return named;
}

/// \throw InputError if B has other names than A
void require_same_names(const NamedTextures& a, const NamedTextures& b, const std::string& file_a,
                        const std::string& file_b) {
  if (a.size() != b.size()) {
    throw InputError(file_b + ": has " + count_text(b.size(), "image", "images") + ", " + file_a +
                     " has " + std::to_string(a.size()));
  }
  for (const auto& [name, texture] : a) {
    if (!b.contains(name)) throw InputError(file_b + ": has no image " + name + ", as " + file_a);
  }
}

/// The pair's name for a texture of the mesh: its own, or the same but for folder and extension.
std::string name_of_worn(const SetTexture& worn, const std::string& mesh,
                         const NamedTextures& textures) {
  const std::string own = name_in(mesh, worn);
  if (textures.contains(own)) return own;
  for (const auto& [name, texture] : textures) {
    if (texture.path.stem() == worn.path.stem()) return name;
  }
  throw UsageError("--mesh: " + worn.path.filename().string() +
                   " of its materials is not among the textures compared");
}

}  // namespace

GltfPairs pair_gltf_images(const Arguments& arguments) {
  const std::string file_a = arguments.argument("a"), file_b = arguments.argument("b");
  GltfPairs result;
  result.mesh = read_input_mesh(arguments.optional_text("mesh").value_or(file_a), arguments);
  warn(result.mesh.read.warnings);
  const auto textures_of = [&](const std::string& file) {
    if (file == result.mesh.path) return named_textures(file, result.mesh.as_read, arguments);
    ReadReport report;
    const TriangleMesh mesh = read_mesh_file(file, arguments, report);
    warn(report.warnings);
    return named_textures(file, mesh, arguments);
  };
  const NamedTextures a = textures_of(file_a), b = textures_of(file_b);
  require_same_names(a, b, file_a, file_b);
  result.set = textures_worn(result.mesh.cleaned, arguments);
  for (const SetTexture& worn : result.set.textures) {
    const std::string name = name_of_worn(worn, result.mesh.path, a);
    result.a.push_back(a.at(name));
    result.b.push_back(b.at(name));
  }
  return result;
}

}  // namespace onmesh::tools
