#include "onmesh/mesh_io/read_off.h"

#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/polygon_mesh.h"
#include "onmesh/mesh_io/printed_precision.h"

namespace onmesh {
namespace {

std::size_t read_count(std::string_view token, const char* what, const TextScan& scan) {
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

/// What the first lines say.
struct OffHeader {
  bool has_uvs = false, has_colours = false, has_normals = false;
  std::size_t vertices = 0, faces = 0;
};

OffHeader read_header(TextScan& scan) {
  OffHeader header;
  std::string_view magic = scan.token_anywhere();
  const std::string_view first = magic;
  if (magic.starts_with("ST")) header.has_uvs = true, magic.remove_prefix(2);
  if (magic.starts_with('C')) header.has_colours = true, magic.remove_prefix(1);
  if (magic.starts_with('N')) header.has_normals = true, magic.remove_prefix(1);
  if (magic.starts_with('4') || magic.starts_with('n'))
    scan.fail("only three-dimensional OFF files are read");
  if (!magic.starts_with("OFF")) scan.fail("is not an OFF file: " + quote(first));
  magic.remove_prefix(3);
  // Some files have no blank between the keyword and the first count.
  const std::string_view token = magic.empty() ? scan.token_anywhere() : magic;
  if (token == "BINARY") scan.fail("binary OFF files are not read");
  header.vertices = read_count(token, "number of vertices", scan);
  header.faces = read_count(scan.token_anywhere(), "number of faces", scan);
  scan.next_line();  // the number of edges means nothing

  // At least "0 0 0" and "3 0 0 0" with a line end each, so that no count makes us allocate.
  if (header.vertices > scan.remaining() / 6 + 1 || header.faces > scan.remaining() / 8 + 1) {
    scan.fail("promises " + std::to_string(header.vertices) + " vertices and " +
              std::to_string(header.faces) + " faces, the file is too short for them");
  }
  return header;
}

void read_vertices(TextScan& scan, const OffHeader& header, PolygonMesh& out) {
  out.mesh.positions.reserve(header.vertices);
  std::vector<double> rest;
  PrintedPrecision precision;
  for (std::size_t i = 0; i < header.vertices; ++i, scan.next_line()) {
    next_filled_line(scan);
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = finite_coordinate(scan, precision);
    out.mesh.positions.push_back(p);
    if (!header.has_uvs) continue;
    // Colours between the normal and the texture coordinates may have any number of components.
    rest.clear();
    while (scan.skip_blank()) rest.push_back(scan.number("value behind the coordinates"));
    if (rest.size() < (header.has_normals ? 5U : 2U))
      scan.fail("vertex has no texture coordinates");
    out.mesh.uvs.emplace_back(rest[rest.size() - 2], rest.back());
  }
  out.mesh.precision = precision.result();
}

void read_faces(TextScan& scan, const OffHeader& header, PolygonMesh& out) {
  for (std::size_t i = 0; i < header.faces; ++i, scan.next_line()) {
    next_filled_line(scan);
    const std::size_t corners = read_count(scan.token(), "number of corners", scan);
    if (corners < 3)
      scan.fail("a face needs at least 3 corners, here are " + std::to_string(corners));
    for (std::size_t k = 0; k < corners; ++k) {
      const std::size_t v = read_count(scan.token(), "vertex index", scan);
      if (v >= header.vertices) {
        scan.fail("vertex index " + std::to_string(v) + " is out of range (" +
                  std::to_string(header.vertices) + " vertices)");
      }
      const auto vertex = static_cast<Index>(v);
      out.add_corner(vertex, header.has_uvs ? vertex : kNone);
    }
    out.end_polygon(kNone);
  }
}

void report_header(const OffHeader& header, ReadReport& report) {
  report.read.push_back("OFF, " + std::to_string(header.vertices) + " vertices, " +
                        std::to_string(header.faces) + " faces");
  if (header.has_uvs) report.read.emplace_back("ST: texture coordinates of the vertices");
  if (header.has_colours) report.ignored.emplace_back("C: colours of the vertices");
  if (header.has_normals) report.ignored.emplace_back("N: normals of the vertices");
}

}  // namespace

TriangleMesh read_off(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& /*options*/, ReadReport& report) {
  TextScan scan(content, path.string(), Syntax::comments);
  const OffHeader header = read_header(scan);
  report_header(header, report);
  PolygonMesh out;
  read_vertices(scan, header, out);
  read_faces(scan, header, out);
  drop_missing_uvs(out, path.string(), report);
  return triangulate(std::move(out), path.string());
}

}  // namespace onmesh
