#include "onmesh/mesh_io/mesh_io.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <optional>
#include <set>
#include <system_error>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

enum class MeshFormat { obj, ply, off, stl };

std::optional<MeshFormat> format_of_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".obj") return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".off") return MeshFormat::off;
  if (extension == ".stl") return MeshFormat::stl;
  return std::nullopt;
}

bool is_binary_stl(const std::string& content) {
  if (content.size() < 84) return false;
  std::uint64_t facets = 0;
  for (int i = 3; i >= 0; --i)
    facets = facets << 8 | static_cast<unsigned char>(content[80 + static_cast<std::size_t>(i)]);
  return facets > 0 && content.size() == 84 + 50 * facets;
}

/// What the content is, if it says so beyond doubt.
std::optional<MeshFormat> format_of_content(const std::string& content) {
  if (is_binary_stl(content)) return MeshFormat::stl;
  TextScan scan(content, {}, Syntax::comments);
  const std::string_view first = scan.token_anywhere();
  if (first == "ply") return MeshFormat::ply;
  if (content.find('\0') != std::string::npos) return std::nullopt;
  for (const std::string_view prefix : {"", "C", "N", "CN", "ST", "STC", "STN", "STCN"}) {
    if (first.starts_with(std::string(prefix) + "OFF")) return MeshFormat::off;
  }
  if (first == "solid") {
    scan.next_line();
    const std::string_view second = scan.token_anywhere();
    if (second == "facet" || second == "endsolid") return MeshFormat::stl;
  }
  // A line "v x y z" within the first lines makes an OBJ.
  TextScan lines(content, {}, Syntax::comments_continuations);
  for (; lines.line() < 10'000 && !lines.at_end(); lines.next_line()) {
    if (lines.token() != "v") continue;
    double value = 0;
    for (int i = 0; i < 3; ++i) {
      if (!parse_number(lines.token(), value)) return std::nullopt;
    }
    return MeshFormat::obj;
  }
  return std::nullopt;
}

void append_number(std::string& out, double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), end);
}

/// Names end at the line's end and lose blanks at their ends when read.
std::string line_name(const std::string& name, std::size_t number) {
  std::string result = name;
  for (char& c : result) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  const std::size_t begin = result.find_first_not_of(" \t");
  if (begin == std::string::npos) return "material_" + std::to_string(number);
  return result.substr(begin, result.find_last_not_of(" \t") - begin + 1);
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
    out += "map_Kd " + std::string(name.starts_with('-') ? "./" : "") + name + "\n";
  }
  return out;
}

}  // namespace

TriangleMesh read_mesh(const fs::path& path, std::vector<std::string>* warnings) {
  const std::string content = read_file(path);
  if (content.empty()) throw InputError(path.string() + ": is empty");
  const auto expected = format_of_extension(path);
  const auto found = format_of_content(content);
  if (!expected && !found) {
    throw InputError(path.string() + ": is no mesh that can be read (OBJ, PLY, OFF or STL)");
  }
  const MeshFormat format = found.value_or(expected.value_or(MeshFormat::obj));
  if (expected && format != *expected && warnings) {
    constexpr std::array<const char*, 4> names = {"OBJ", "PLY", "OFF", "STL"};
    warnings->push_back(path.string() + ": is read as " + names[static_cast<std::size_t>(format)] +
                        ", which it holds in spite of its name");
  }
  switch (format) {
    case MeshFormat::obj:
      return read_obj(path, content, warnings);
    case MeshFormat::ply:
      return read_ply(path, content, warnings);
    case MeshFormat::off:
      return read_off(path, content, warnings);
    case MeshFormat::stl:
      break;
  }
  return read_stl(path, content, warnings);
}

void write_obj(const fs::path& path, const TriangleMesh& mesh) {
  const fs::path mtl = fs::path(path).replace_extension(".mtl");
  const std::vector<std::string> names = material_names(mesh.materials);
  std::string out;
  out.reserve(mesh.positions.size() * 48 + mesh.uvs.size() * 40 + mesh.faces.size() * 40);
  if (!names.empty()) out += "mtllib " + mtl.filename().string() + "\n";
  for (const Vec3& p : mesh.positions) {
    out += 'v';
    for (int i = 0; i < 3; ++i) append_number(out += ' ', p[i]);
    out += '\n';
  }
  for (const Vec2& uv : mesh.uvs) {
    append_number(out += "vt ", uv.x());
    append_number(out += ' ', uv.y());
    out += '\n';
  }
  Index material = kNone;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_materials[f] != material) {
      material = mesh.face_materials[f];
      out += "usemtl " + (material == kNone ? std::string() : names[material]) + "\n";
    }
    out += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      out += ' ' + std::to_string(std::size_t{mesh.faces[f][k]} + 1);
      if (mesh.face_uvs[f][k] != kNone)
        out += '/' + std::to_string(std::size_t{mesh.face_uvs[f][k]} + 1);
    }
    out += '\n';
  }
  // The material file first: an OBJ must not name one that is not there.
  if (!names.empty()) write_file(mtl, mtl_content(mesh, names, path.parent_path()));
  write_file(path, out);
}

}  // namespace onmesh
