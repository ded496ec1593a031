#include "onmesh/mesh_io/write_obj.h"

#include <array>
#include <charconv>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "onmesh/base/file_io.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

void append_number(std::string& out, double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), end);
}

/// Names end at the line's end and lose blanks at their ends when read; a backslash there would
/// join the line with the next.
std::string line_name(const std::string& name, std::size_t number) {
  std::string result = name;
  for (char& c : result) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  const std::size_t begin = result.find_first_not_of(" \t");
  if (begin == std::string::npos) return "material_" + std::to_string(number);
  result = result.substr(begin, result.find_last_not_of(" \t") - begin + 1);
  if (result.back() == '\\') result += '_';
  return result;
}

/// Different materials must not become one: nameless and equal names get a number.
std::vector<std::string> material_names(const std::vector<Material>& materials) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::string name = line_name(materials[i].name, i);
    for (std::size_t k = i; !taken.insert(name).second; ++k) {
      name = line_name(materials[i].name, i) + "_" + std::to_string(k);
    }
    names.push_back(name);
  }
  return names;
}

/// A file's name such that nothing at its beginning is taken for something else.
std::string file_name(const std::string& name) {
  const bool plain = name.find_first_of("-#\" \t") != 0;
  return (plain ? "" : "./") + name;
}

std::string mtl_content(const TriangleMesh& mesh, const std::vector<std::string>& names,
                        const fs::path& folder) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += "newmtl " + names[i] + "\nKd 1 1 1\n";
    if (mesh.materials[i].texture.empty()) continue;
    std::error_code error;
    const fs::path texture =
        fs::relative(mesh.materials[i].texture, folder.empty() ? "." : folder, error);
    const std::string name =
        error || texture.empty() ? mesh.materials[i].texture : texture.string();
    // MTL has no words for other modes than repeating, and none for one direction alone.
    const bool clamps = mesh.materials[i].wrap == WrapModes(Wrap::clamp);
    out += std::string("map_Kd ") + (clamps ? "-clamp on " : "") + file_name(name) + "\n";
  }
  return out;
}

void append_points(std::string& out, const char* keyword, const std::vector<Vec3>& points) {
  for (const Vec3& p : points) {
    out += keyword;
    for (int i = 0; i < 3; ++i) append_number(out += ' ', p[i]);
    out += '\n';
  }
}

/// The mesh as an OBJ.
/// \param names of its materials
/// \param mtl the material file, named if there are materials
std::string obj_content(const TriangleMesh& mesh, const std::vector<std::string>& names,
                        const fs::path& mtl) {
  std::string out;
  out.reserve(mesh.positions.size() * 48 + mesh.uvs.size() * 40 + mesh.normals.size() * 48 +
              mesh.faces.size() * 40);
  if (!names.empty()) out += "mtllib " + file_name(mtl.filename().string()) + "\n";
  append_points(out, "v", mesh.positions);
  for (const Vec2& uv : mesh.uvs) {
    append_number(out += "vt ", uv.x());
    append_number(out += ' ', uv.y());
    out += '\n';
  }
  append_points(out, "vn", mesh.normals);
  Index material = kNone;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_materials[f] != material) {
      material = mesh.face_materials[f];
      out += "usemtl " + (material == kNone ? std::string() : names[material]) + "\n";
    }
    out += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const Index uv = mesh.face_uvs[f][k];
      const Index normal = mesh.face_normals.empty() ? kNone : mesh.face_normals[f][k];
      out += ' ' + std::to_string(std::size_t{mesh.faces[f][k]} + 1);
      if (uv != kNone || normal != kNone) out += '/';
      if (uv != kNone) out += std::to_string(std::size_t{uv} + 1);
      if (normal != kNone) out += '/' + std::to_string(std::size_t{normal} + 1);
    }
    out += '\n';
  }
  return out;
}

}  // namespace

void write_obj(const fs::path& path, const TriangleMesh& mesh) {
  const fs::path mtl = fs::path(path).replace_extension(".mtl");
  const std::vector<std::string> names = material_names(mesh.materials);
  const std::string obj = obj_content(mesh, names, mtl);
  // The material file first: an OBJ must not name one that is not there.
  if (!names.empty()) write_file(mtl, mtl_content(mesh, names, path.parent_path()));
  write_file(path, obj);
}

}  // namespace onmesh
