#include "onmesh/mesh_io/read_stl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <utility>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/mesh_io/polygon_mesh.h"
#include "onmesh/mesh_io/printed_precision.h"

namespace onmesh {
namespace {

constexpr std::size_t kHeaderSize = 84, kFacetSize = 50;

bool equals(std::string_view token, std::string_view lower_case) {
  return token.size() == lower_case.size() &&
         std::equal(token.begin(), token.end(), lower_case.begin(),
                    [](char a, char b) { return (a | 0x20) == b; });
}

/// Text if it starts with "solid" and the size is not the one that a binary file of that facet
/// count has: many binary files start with "solid" too.
bool is_text(const std::string& content) {
  const std::size_t begin = content.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || !equals(std::string_view(content).substr(begin, 5), "solid"))
    return false;
  return !is_binary_stl(content) && content.find('\0') == std::string::npos;
}

void add_facet(PolygonMesh& out, const std::array<Vec3, 3>& corners) {
  for (const Vec3& p : corners) {
    out.add_corner(static_cast<Index>(out.mesh.positions.size()), kNone);
    out.mesh.positions.push_back(p);
  }
  out.end_polygon(kNone);
}

void read_text(const std::string& content, const std::string& file, PolygonMesh& out) {
  TextScan scan(content, file, Syntax::plain);
  PrintedPrecision precision;
  const auto expect = [&](std::string_view word) {
    const std::string_view token = scan.token_anywhere();
    if (token.empty()) scan.fail("file ends where '" + std::string(word) + "' should follow");
    if (!equals(token, word))
      scan.fail("expected '" + std::string(word) + "', here is " + quote(token));
  };
  for (;;) {
    // The name behind "solid" may hold anything, or nothing.
    expect("solid");
    scan.next_line();
    for (std::string_view token = scan.token_anywhere(); !equals(token, "endsolid");
         token = scan.token_anywhere()) {
      if (token.empty()) scan.fail("file ends without 'endsolid', it may be cut off");
      if (!equals(token, "facet"))
        scan.fail("expected 'facet' or 'endsolid', here is " + quote(token));
      scan.next_line();  // the normal follows from the corners
      expect("outer");
      expect("loop");
      std::array<Vec3, 3> corners;
      for (Vec3& p : corners) {
        expect("vertex");
        for (int k = 0; k < 3; ++k) p[k] = finite_coordinate(scan, precision);
      }
      expect("endloop");
      expect("endfacet");
      add_facet(out, corners);
    }
    scan.next_line();
    while (!scan.at_end() && !scan.skip_blank()) scan.next_line();
    if (scan.at_end()) break;
  }
  out.mesh.precision = precision.result();
}

void read_binary(const std::string& content, const std::string& file, PolygonMesh& out,
                 ReadReport& report) {
  if (content.size() < kHeaderSize) throw InputError(file + ": is not an STL file (too short)");
  const std::size_t facets = from_bytes<std::uint32_t>(content.data() + 80, std::endian::little);
  const std::size_t held = (content.size() - kHeaderSize) / kFacetSize;
  if (facets > held) {
    throw InputError(file + ": promises " + std::to_string(facets) + " facets, the file holds " +
                     std::to_string(held) + " (cut off, or no STL)");
  }
  if (content.size() != kHeaderSize + kFacetSize * facets) {
    report.warnings.push_back(file + ": bytes behind the last facet are ignored");
  }
  if (facets > kNone / 3) throw InputError(file + ": has more vertices than 32 bits can count");
  out.mesh.precision.single = true;
  out.mesh.positions.reserve(3 * facets);
  for (std::size_t i = 0; i < facets; ++i) {
    // 12 bytes of normal come first.
    const char* const at = content.data() + kHeaderSize + kFacetSize * i + 12;
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 9; ++k) {
      corners[k / 3][static_cast<int>(k % 3)] =
          static_cast<double>(from_bytes<float>(at + 4 * k, std::endian::little));
    }
    for (const Vec3& p : corners) {
      if (!p.allFinite())
        throw InputError(file + ": facet " + std::to_string(i) +
                         " has a coordinate that is not finite");
    }
    add_facet(out, corners);
  }
}

}  // namespace

bool is_binary_stl(const std::string& content) {
  if (content.size() < kHeaderSize) return false;
  const std::uint64_t facets = from_bytes<std::uint32_t>(content.data() + 80, std::endian::little);
  return facets > 0 && content.size() == kHeaderSize + kFacetSize * facets;
}

TriangleMesh read_stl(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& /*options*/, ReadReport& report) {
  PolygonMesh out;
  const bool as_text = is_text(content);
  if (as_text) {
    read_text(content, path.string(), out);
  } else {
    read_binary(content, path.string(), out, report);
  }
  report.read.push_back(std::string(as_text ? "text" : "binary") + " STL, " +
                        std::to_string(out.polygon_end.size()) + " facets");
  report.ignored.emplace_back("normals of the facets: they follow from the corners");
  return triangulate(std::move(out), path.string());
}

}  // namespace onmesh
