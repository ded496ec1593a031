#include "inputs.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "texture_choice.h"

namespace onmesh::tools {
namespace {

namespace fs = std::filesystem;

// "512x256"
void parse_resolution(const std::string& text, Atlas& atlas) {
  const char* const end = text.data() + text.size();
  const auto [cross, first] = std::from_chars(text.data(), end, atlas.width);
  if (first == std::errc() && cross != end && (*cross == 'x' || *cross == 'X')) {
    const auto [rest, second] = std::from_chars(cross + 1, end, atlas.height);
    const auto fits = [](int side) { return side >= 1 && side <= 32768; };
    if (second == std::errc() && rest == end && fits(atlas.width) && fits(atlas.height)) return;
  }
  throw UsageError("--resolution: '" + text + "' is not WIDTHxHEIGHT with sides of 1 to 32768");
}

}  // namespace

InputMesh read_input_mesh(const std::string& path) {
  InputMesh mesh;
  mesh.path = path;
  mesh.as_read = read_mesh(path, &mesh.warnings);
  mesh.welded = weld(mesh.as_read);
  mesh.cleaned = clean(mesh.welded, &mesh.cleaning);
  return mesh;
}

std::vector<std::string> named_textures(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.materials.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_materials[f] != kNone && mesh.has_uvs(f)) used[mesh.face_materials[f]] = true;
  }
  std::vector<std::string> names;
  for (std::size_t m = 0; m < used.size(); ++m) {
    const std::string& name = mesh.materials[m].texture;
    if (used[m] && !name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  }
  return names;
}

std::vector<bool> faces_with_texture(const TriangleMesh& mesh, const std::string& texture) {
  std::vector<bool> faces(mesh.faces.size(), false);
  for (Index f = 0; f < faces.size(); ++f) {
    const Index material = mesh.face_materials[f];
    faces[f] = material != kNone && mesh.materials[material].texture == texture && mesh.has_uvs(f);
  }
  return faces;
}

void add_atlas_options(po::options_description& options) {
  auto add = options.add_options();
  add("texture,t", text(),
      "a texture of the atlas (default: the one that the mesh's materials name)");
  add("resolution", text(), "size of the atlas instead of a texture, such as 1024x1024");
  add("material", text(), "only the faces of this material; all = every face with UVs");
  add("wrap", text("repeat"), "what UVs outside [0,1] mean: repeat or clamp");
}

bool has_atlas_option(const po::variables_map& values) {
  return has(values, "texture") || has(values, "resolution");
}

Atlas read_atlas(const po::variables_map& values, const TriangleMesh& mesh,
                 const std::string& texture) {
  Atlas atlas;
  atlas.map.wrap = wrap_of(values);
  const auto material = optional_text(values, "material");
  if (has(values, "resolution")) {
    if (has(values, texture)) throw UsageError("-t and --resolution exclude each other");
    parse_resolution(text_of(values, "resolution"), atlas);
    if (material) atlas.map.faces = choose_texture(mesh, "", material).faces;
    return atlas;
  }
  TextureChoice choice;
  try {
    choice = choose_texture(mesh, optional_text(values, texture), material);
  } catch (const UsageError& error) {
    if (has(values, texture)) throw;
    throw UsageError(std::string(error.what()) + ", or give --resolution");
  }
  atlas.texture = choice.path.string();
  atlas.map.faces = std::move(choice.faces);
  atlas.image = read_image(atlas.texture);
  atlas.width = atlas.image.width;
  atlas.height = atlas.image.height;
  return atlas;
}

std::optional<std::string> optional_text(const po::variables_map& values, const std::string& name) {
  return has(values, name) ? std::optional(text_of(values, name)) : std::nullopt;
}

Wrap wrap_of(const po::variables_map& values) {
  const std::string name = text_of(values, "wrap");
  if (name == "repeat") return Wrap::repeat;
  if (name == "clamp") return Wrap::clamp;
  throw UsageError("--wrap: '" + name + "' is not repeat or clamp");
}

void check_writable_file(const std::string& path) {
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw FileError(path + ": cannot write here: the folder does not exist");
  if (fs::is_directory(target, error))
    throw FileError(path + ": cannot write here: it is a folder");
  if (!fs::exists(target, error) && ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(path + ": cannot write in the folder: " + std::strerror(errno));
}

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::optional<Length> bridge_of(const po::variables_map& values) {
  const std::string width = text_of(values, "bridge");
  return width == "0" ? std::nullopt : std::optional(parse_length("--bridge", width));
}

std::string format_number(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return buffer.data();
}

}  // namespace onmesh::tools
