#include <catch2/catch.hpp>
#include <cstring>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/mesh_io.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Face = std::array<Index, 3>;

namespace {

template <class Reader>
std::string error_of(Reader reader, const std::string& content) {
  try {
    reader("m", content, nullptr);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TriangleMesh off(const std::string& content) { return read_off("m", content, nullptr); }
TriangleMesh stl(const std::string& content) { return read_stl("m", content, nullptr); }

const std::string kTriangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string binary_stl(const std::string& header, const std::vector<std::array<float, 9>>& facets) {
  std::string out = header + std::string(80 - header.size(), ' ');
  const auto add = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(static_cast<std::uint32_t>(facets.size()));
  for (const auto& f : facets) {
    for (int i = 0; i < 3; ++i) add(0.F);
    for (const float v : f) add(v);
    add(std::uint16_t{0});
  }
  return out;
}

const std::array<float, 9> kFacet = {0, 0, 0, 1, 0, 0, 0, 1, 0};

}  // namespace

TEST_CASE("OFF files read with and without colours, normals, comments and line breaks",
          "[mesh_io]") {
  for (const std::string& text : std::vector<std::string>{
           "OFF\n3 1 0\n" + kTriangle, "OFF 3 1 0\n" + kTriangle, "OFF3 1 0\n" + kTriangle,
           "OFF\n3 1\n" + kTriangle,
           "# c\nOFF # c\n\n# c\n3 1 0 # c\n\n0 0 0 # c\n# c\n1 0 0\n0 1 0\n\n3 0 1 2 # c",
           "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
           "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 .5 .5 .5 1\n0 1 0 7\n3 0 1 2 .1 .2 .3\n",
           "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n"}) {
    INFO(text);
    const TriangleMesh mesh = off(text);
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK_FALSE(mesh.has_uvs(0));
  }
}

TEST_CASE("OFF files with the prefix ST have UVs behind everything else", "[mesh_io]") {
  for (const std::string text :
       {"STOFF\n3 1 0\n0 0 0 .1 .2\n1 0 0 .3 .4\n0 1 0 .5 .6\n3 0 1 2\n",
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 9 9 9 .1 .2\n1 0 0 0 0 1 9 9 9 .3 .4\n"
        "0 1 0 0 0 1 9 9 9 .5 .6\n3 0 1 2\n"}) {
    const TriangleMesh mesh = off(text);
    CHECK(mesh.uvs == std::vector<Vec2>{{.1, .2}, {.3, .4}, {.5, .6}});
    CHECK(mesh.has_uvs(0));
  }
}

TEST_CASE("a bad OFF file is refused with its line", "[mesh_io]") {
  const auto fails = [](const std::string& text) { return error_of(read_off, text); };
  CHECK_THAT(fails("OFF BINARY\n"), StartsWith("m:1: binary OFF"));
  CHECK_THAT(fails("4OFF\n3 1 0\n" + kTriangle), Contains("three-dimensional"));
  CHECK_THAT(fails("MOFF\n3 1 0\n" + kTriangle), Contains("is not an OFF file"));
  CHECK_THAT(fails("OFF\nx 1 0\n" + kTriangle), StartsWith("m:2: number of vertices"));
  CHECK_THAT(fails("OFF\n-3 1 0\n" + kTriangle), StartsWith("m:2: number of vertices"));
  CHECK_THAT(fails("OFF\n3000000000 1 0\n" + kTriangle), Contains("too short"));
  CHECK_THAT(fails("OFF\n3 99999999999 0\n" + kTriangle), Contains("too short"));
  CHECK_THAT(fails("OFF\n4 1 0\n" + kTriangle), Contains("ends before"));
  CHECK_THAT(fails("OFF\n3 2 0\n" + kTriangle), Contains("ends before"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
             StartsWith("m:4: coordinate is missing"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n"),
             StartsWith("m:4: coordinate is not finite"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
             StartsWith("m:6: vertex index 3 is out of range"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
             StartsWith("m:6: vertex index is not a number"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
             StartsWith("m:6: a face needs at least 3"));
  CHECK_THAT(fails("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n9 0 1 2\n"),
             StartsWith("m:6: vertex index is not a number"));
  CHECK_THAT(fails("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), Contains("no faces"));
  CHECK_THAT(fails("STOFF\n3 1 0\n0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2\n"),
             Contains("no texture coordinates"));
  CHECK_THAT(fails("OFF"), Contains("number of vertices"));
}

TEST_CASE("STL files read as text and binary, even binary ones that start with solid",
          "[mesh_io]") {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  for (const std::string& text : std::vector<std::string>{
           "solid a facet name\n" + facet + "endsolid a\n",
           "SOLID\r\n FACET NORMAL 0 0 1\r\n OUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\n"
           "VERTEX 0 1 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID",
           binary_stl("", {kFacet}), binary_stl("solid binary", {kFacet}),
           binary_stl("solid", {kFacet}) + "tail"}) {
    const TriangleMesh mesh = stl(text);
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
  }
  const TriangleMesh two =
      stl("solid a\n" + facet + "endsolid a\nsolid b\n" + facet + facet + "endsolid b\n\n");
  CHECK(two.faces.size() == 3);
  CHECK(weld(two).positions.size() == 3);
}

TEST_CASE("a bad STL file is refused", "[mesh_io]") {
  const auto fails = [](const std::string& text) { return error_of(read_stl, text); };
  CHECK_THAT(fails("solid a\nendsolid a\n"), Contains("no faces"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"),
             StartsWith("m:4: coordinate is missing"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"),
             StartsWith("m:4: coordinate is not a number"));
  CHECK_THAT(
      fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nendloop\n"),
      StartsWith("m:6: expected 'vertex', here is 'endloop'"));
  CHECK_THAT(fails("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 "
                   "0 0\nendloop\nendfacet\n"),
             Contains("without 'endsolid'"));
  CHECK_THAT(fails("solid a\nface\n"), Contains("expected 'facet' or 'endsolid'"));
  CHECK_THAT(fails("short"), Contains("too short"));
  std::string cut = binary_stl("", {kFacet, kFacet});
  cut.resize(cut.size() - 1);
  CHECK_THAT(fails(cut), Contains("promises 2 facets, the file holds 1"));
  std::string huge = binary_stl("", {kFacet});
  std::memset(huge.data() + 80, 0xff, 4);
  CHECK_THAT(fails(huge), Contains("promises 4294967295 facets"));
  std::array<float, 9> nan = kFacet;
  nan[4] = std::nanf("");
  CHECK_THAT(fails(binary_stl("", {kFacet, nan})),
             Contains("facet 1 has a coordinate that is not finite"));
  CHECK_THAT(fails(binary_stl("", {})), Contains("no faces"));
}
