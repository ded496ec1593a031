#include "onmesh/mesh_io/read_mesh.h"

#include <array>
#include <bit>
#include <cctype>
#include <optional>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/gltf/read_gltf.h"
#include "onmesh/mesh_io/read_obj.h"
#include "onmesh/mesh_io/read_off.h"
#include "onmesh/mesh_io/read_ply.h"
#include "onmesh/mesh_io/read_stl.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

enum class MeshFormat { obj, ply, off, stl, gltf };

std::optional<MeshFormat> format_of_extension(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".obj") return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".off") return MeshFormat::off;
  if (extension == ".stl") return MeshFormat::stl;
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::gltf;
  return std::nullopt;
}

/// What the content is, if it says so beyond doubt.
std::optional<MeshFormat> format_of_content(const std::string& content) {
  if (looks_like_gltf(content)) return MeshFormat::gltf;
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

}  // namespace

TriangleMesh read_mesh(const fs::path& path, ReadReport* report, const ReadOptions& options) {
  ReadReport unwanted;
  ReadReport& told = report != nullptr ? *report : unwanted;
  const std::string content = read_file(path);
  if (content.empty()) throw InputError(path.string() + ": is empty");
  const auto expected = format_of_extension(path);
  const auto found = format_of_content(content);
  if (!expected && !found) {
    throw InputError(path.string() + ": is no mesh that can be read (OBJ, PLY, OFF, STL or glTF)");
  }
  const MeshFormat format = found.value_or(expected.value_or(MeshFormat::obj));
  if (expected && format != *expected) {
    constexpr std::array<const char*, 5> names = {"OBJ", "PLY", "OFF", "STL", "glTF"};
    told.warnings.push_back(path.string() + ": is read as " +
                            names[static_cast<std::size_t>(format)] +
                            ", which it holds in spite of its name");
  }
  switch (format) {
    case MeshFormat::obj:
      return read_obj(path, content, options, told);
    case MeshFormat::ply:
      return read_ply(path, content, options, told);
    case MeshFormat::gltf:
      return read_gltf(path, content, options, told);
    case MeshFormat::off:
      return read_off(path, content, options, told);
    case MeshFormat::stl:
      break;
  }
  return read_stl(path, content, options, told);
}

}  // namespace onmesh
