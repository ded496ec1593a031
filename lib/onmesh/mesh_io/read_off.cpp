// OFF, with the prefixes ST (texture coordinates), C (colours) and N (normals).
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/mesh_io.h"
#include "onmesh/mesh_io/polygon_mesh.h"

namespace onmesh {
namespace {

std::size_t count(std::string_view token, const char* what, const TextScan& scan) {
  std::size_t value = 0;
  const char* const end = token.data() + token.size();
  const auto [last, error] = std::from_chars(token.data(), end, value);
  if (token.empty() || error != std::errc() || last != end) {
    scan.fail(std::string(what) + " is not a number: " + quote(token));
  }
  return value;
}

/// Go to the next line that has a token.
void next_filled_line(TextScan& scan) {
  while (!scan.skip_blank()) {
    if (scan.at_end()) scan.fail("file ends before all its vertices and faces");
    scan.next_line();
  }
}

}  // namespace

TriangleMesh read_off(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings) {
  TextScan scan(content, path.string(), Syntax::comments);
  std::string_view magic = scan.token_anywhere();
  const std::string_view first = magic;
  bool has_uvs = false, has_normals = false;
  if (magic.starts_with("ST")) has_uvs = true, magic.remove_prefix(2);
  if (magic.starts_with('C')) magic.remove_prefix(1);
  if (magic.starts_with('N')) has_normals = true, magic.remove_prefix(1);
  if (magic.starts_with('4') || magic.starts_with('n'))
    scan.fail("only three-dimensional OFF files are read");
  if (!magic.starts_with("OFF")) scan.fail("is not an OFF file: " + quote(first));
  magic.remove_prefix(3);
  // Some files have no blank between the keyword and the first count.
  std::string_view token = magic.empty() ? scan.token_anywhere() : magic;
  if (token == "BINARY") scan.fail("binary OFF files are not read");
  const std::size_t vertices = count(token, "number of vertices", scan);
  const std::size_t faces = count(scan.token_anywhere(), "number of faces", scan);
  scan.next_line();  // the number of edges means nothing

  // At least "0 0 0" and "3 0 0 0" with a line end each, so that no count makes us allocate.
  if (vertices > scan.remaining() / 6 + 1 || faces > scan.remaining() / 8 + 1) {
    scan.fail("promises " + std::to_string(vertices) + " vertices and " + std::to_string(faces) +
              " faces, the file is too short for them");
  }
  PolygonMesh out;
  out.mesh.positions.reserve(vertices);
  std::size_t missing_uvs = 0;
  std::vector<double> rest;
  for (std::size_t i = 0; i < vertices; ++i, scan.next_line()) {
    next_filled_line(scan);
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = scan.finite("coordinate");
    out.mesh.positions.push_back(p);
    if (!has_uvs) continue;
    // Colours between the normal and the texture coordinates may have any number of components.
    rest.clear();
    while (scan.skip_blank()) rest.push_back(scan.number("value behind the coordinates"));
    if (rest.size() < (has_normals ? 5U : 2U)) scan.fail("vertex has no texture coordinates");
    out.mesh.uvs.emplace_back(rest[rest.size() - 2], rest.back());
    if (!out.mesh.uvs.back().allFinite()) ++missing_uvs;
  }
  for (std::size_t i = 0; i < faces; ++i, scan.next_line()) {
    next_filled_line(scan);
    const std::size_t corners = count(scan.token(), "number of corners", scan);
    if (corners < 3)
      scan.fail("a face needs at least 3 corners, here are " + std::to_string(corners));
    for (std::size_t k = 0; k < corners; ++k) {
      const std::size_t v = count(scan.token(), "vertex index", scan);
      if (v >= vertices) {
        scan.fail("vertex index " + std::to_string(v) + " is out of range (" +
                  std::to_string(vertices) + " vertices)");
      }
      const auto vertex = static_cast<Index>(v);
      out.add_corner(vertex, has_uvs && out.mesh.uvs[v].allFinite() ? vertex : kNone);
    }
    out.end_polygon(kNone);
  }
  for (Vec2& uv : out.mesh.uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  if (missing_uvs > 0 && warnings) {
    warnings->push_back(path.string() + ": " + std::to_string(missing_uvs) +
                        " texture coordinates are not finite and count as missing");
  }
  return triangulate(std::move(out), path.string());
}

}  // namespace onmesh
