#include "onmesh/mesh_io/ply_properties.h"

#include <catch2/catch.hpp>

#include "support/ply_files.h"
#include "support/refused.h"

using namespace onmesh;
using Catch::Matchers::Contains;

namespace {

/// An element whose properties are floats of these names.
PlyElement floats(const std::vector<std::string>& names) {
  PlyElement element{"vertex", 1, {}};
  for (const std::string& name : names) element.properties.push_back({name, {}, {}});
  return element;
}

}  // namespace

TEST_CASE("of several pairs of UVs a PLY file's first one is taken", "[ply_properties]") {
  using enum VertexValue;
  ReadReport report;
  const VertexProperties properties = vertex_properties(
      floats({"t1", "x", "u", "y", "texture_v", "s1", "z", "v", "s", "texture_u"}), report);
  CHECK(properties.values ==
        std::vector<VertexValue>{unwanted, x, u, y, unwanted, unwanted, z, v, unwanted, unwanted});
  CHECK(properties.uv_names == "u v");
  CHECK(report.ignored ==
        std::vector<std::string>{"vertex: texture coordinates s1 t1",
                                 "vertex: texture coordinates texture_u texture_v", "vertex: s"});
}

TEST_CASE("PLY UVs are known under the names that programs write", "[ply_properties]") {
  for (const auto& [u, v] : {std::pair{"s", "t"},
                             {"u", "v"},
                             {"texture_u", "texture_v"},
                             {"texture_s", "texture_t"},
                             {"s0", "t0"},
                             {"u1", "v1"},
                             {"texcoord_u", "texcoord_v"},
                             {"S", "T"}}) {
    CAPTURE(u, v);
    ReadReport report;
    const TriangleMesh mesh = parse_ply(
        ply_text(kPlyVertices + "property float " + v + "\nproperty float " + u + "\n" + kPlyFace,
                 "0 0 0 0 .5\n1 0 0 0 1\n1 1 0 1 1\n0 1 0 1 0\n3 0 1 2\n"),
        &report);
    REQUIRE(mesh.has_uvs(0));
    CHECK(mesh.uvs[0] == Vec2(0.5, 0));
    CHECK(report.assumed == std::vector<std::string>{std::string("texture coordinates: ") + u +
                                                     " " + v + " of the vertices"});
  }
}

TEST_CASE("PLY names in capitals are taken where there are no others", "[ply_properties]") {
  const std::string faces = "element Face 1\nproperty list uchar int Vertex_Indices\n";
  const auto vertices = [](const std::string& first, const std::string& second) {
    return "element Vertex 3\nproperty float " + first + "\nproperty float " + second +
           "\nproperty float y\nproperty float z\n";
  };
  const std::string body = "1 2 0 0\n3 4 0 0\n5 6 1 0\n3 0 1 2\n";
  CHECK(parse_ply(ply_text(vertices("X", "W") + faces, body)).positions[0].x() == 1);
  CHECK(parse_ply(ply_text(vertices("X", "x") + faces, body)).positions[0].x() == 2);
  CHECK_THAT(error_of(read_ply, "m.ply", ply_text(vertices("W", "Q") + faces, body)),
             Contains("vertices have no x"));
}

TEST_CASE("what a PLY file's vertices hold besides is named", "[ply_properties]") {
  ReadReport report;
  vertex_properties(floats({"x", "nx", "r", "y", "ny", "z", "g", "nz", "b", "radius", "x"}),
                    report);
  CHECK(report.ignored == std::vector<std::string>{"vertex: normals nx ny nz",
                                                   "vertex: colours r g b", "vertex: radius",
                                                   "vertex: x"});
}
