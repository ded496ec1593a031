#include "onmesh/mesh_io/read_off.h"

#include <catch2/catch.hpp>

#include "support/refused.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Face = std::array<Index, 3>;

namespace {

TriangleMesh parse(const std::string& content) {
  ReadReport unwanted;
  return read_off("m", content, {}, unwanted);
}

const std::string kTriangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

}  // namespace

TEST_CASE("OFF files read with and without colours, normals, comments and line breaks",
          "[read_off]") {
  for (const std::string& text : std::vector<std::string>{
           "OFF\n3 1 0\n" + kTriangle, "OFF 3 1 0\n" + kTriangle, "OFF3 1 0\n" + kTriangle,
           "OFF\n3 1\n" + kTriangle,
           "# c\nOFF # c\n\n# c\n3 1 0 # c\n\n0 0 0 # c\n# c\n1 0 0\n0 1 0\n\n3 0 1 2 # c",
           "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
           "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 .5 .5 .5 1\n0 1 0 7\n3 0 1 2 .1 .2 .3\n",
           "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n"}) {
    INFO(text);
    const TriangleMesh mesh = parse(text);
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
    CHECK_FALSE(mesh.has_uvs(0));
  }
}

TEST_CASE("OFF files with the prefix ST have UVs behind everything else", "[read_off]") {
  for (const std::string text :
       {"STOFF\n3 1 0\n0 0 0 .1 .2\n1 0 0 .3 .4\n0 1 0 .5 .6\n3 0 1 2\n",
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 9 9 9 .1 .2\n1 0 0 0 0 1 9 9 9 .3 .4\n"
        "0 1 0 0 0 1 9 9 9 .5 .6\n3 0 1 2\n"}) {
    const TriangleMesh mesh = parse(text);
    CHECK(mesh.uvs == std::vector<Vec2>{{.1, .2}, {.3, .4}, {.5, .6}});
    CHECK(mesh.has_uvs(0));
  }
}

TEST_CASE("a bad OFF file is refused with its line", "[read_off]") {
  const auto fails = [](const std::string& text) { return error_of(read_off, "m", text); };
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

TEST_CASE("an OFF tells what of it was read", "[read_off]") {
  ReadReport report;
  read_off("m",
           "STCNOFF 3 1 0\n0 0 0 0 0 1 1 1 1 .5 .5\n1 0 0 0 0 1 1 1 1 1 .5\n"
           "0 1 0 0 0 1 1 1 1 .5 1\n3 0 1 2\n",
           {}, report);
  CHECK(report.read == std::vector<std::string>{"OFF, 3 vertices, 1 faces",
                                                "ST: texture coordinates of the vertices"});
  CHECK(report.ignored ==
        std::vector<std::string>{"C: colours of the vertices", "N: normals of the vertices"});
}
