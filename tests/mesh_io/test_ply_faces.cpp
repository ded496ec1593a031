#include "onmesh/mesh_io/ply_faces.h"

#include <catch2/catch.hpp>

#include "onmesh/mesh_io/read_mesh.h"
#include "support/ply_files.h"
#include "support/refused.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Faces = std::vector<std::array<Index, 3>>;

namespace {

/// Six vertices in a zigzag, with UVs.
const std::string kZigzagHeader =
    "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nproperty float "
    "s\nproperty float t\n";
const std::string kZigzag = "0 0 0 0 0\n0 1 0 0 1\n1 0 0 .5 0\n1 1 0 .5 1\n2 0 0 1 0\n2 1 0 1 1\n";

std::string strips_header(const std::string& type, char count = '1') {
  std::string header = "element tristrips _\nproperty list int " + type + " vertex_indices\n";
  header[header.find('_')] = count;
  return header;
}

/// A square, one face with these further properties, and their values.
TriangleMesh parse_face(const std::string& properties, const std::string& values,
                        ReadReport& report, const std::string& textures = "") {
  return parse_ply(ply_text(textures + kPlyVertices + kPlyFace + properties, kPlySquare + values),
                   &report);
}

const std::string kThreeTextures =
    "comment TextureFile a.png\ncomment TextureFile b.png\ncomment TextureFile c.png\n";

}  // namespace

TEST_CASE("the triangles of a PLY strip all face the same way", "[ply_faces]") {
  const TriangleMesh mesh =
      parse_ply(ply_text(kZigzagHeader + strips_header("int"), kZigzag + "6 0 2 1 3 4 5\n"));
  // The last ones go on from 1 3 4: not a zigzag any more, but wound in turn all the same.
  CHECK(mesh.faces == Faces{{0, 2, 1}, {1, 2, 3}, {1, 3, 4}, {4, 3, 5}});
  CHECK(mesh.face_uvs == mesh.faces);
  const TriangleMesh sheet =
      parse_ply(ply_text(kZigzagHeader + strips_header("int"), kZigzag + "6 1 0 3 2 5 4\n"));
  REQUIRE(sheet.faces.size() == 4);
  for (Index f = 0; f < 4; ++f) {
    const auto corners = sheet.corners(f);
    CHECK((corners[1] - corners[0]).cross(corners[2] - corners[0]).z() == 1);
  }
}

TEST_CASE("a PLY strip starts again behind -1, in whatever way its type writes that",
          "[ply_faces]") {
  const Faces expected = {{0, 2, 1}, {1, 2, 3}, {3, 2, 5}};
  const auto faces = [](const std::string& type, const std::string& restart) {
    return parse_ply(ply_text(kZigzagHeader + strips_header(type),
                              kZigzag + "11 " + restart + " 0 2 1 3 " + restart + " 4 " + restart +
                                  " 3 2 5 " + "\n"))
        .faces;
  };
  CHECK(faces("int", "-1") == expected);
  CHECK(faces("uint", "4294967295") == expected);
  CHECK(faces("ushort", "65535") == expected);
  CHECK(faces("uchar", "255") == expected);
  CHECK(faces("uint", "-1") == expected);
  CHECK_THAT(error_of(read_ply, "m.ply",
                      ply_text(kZigzagHeader + strips_header("int"), kZigzag + "4 0 1 2 65535\n")),
             Contains("tristrips 0: vertex index 65535 is out of range (6 vertices)"));
  CHECK_THAT(error_of(read_ply, "m.ply",
                      ply_text(kZigzagHeader + strips_header("int"), kZigzag + "4 0 1 2 -2\n")),
             Contains("tristrips 0: vertex index is negative"));
}

TEST_CASE("corners that a PLY strip repeats only lead on", "[ply_faces]") {
  // Every corner turns the next triangle over, repeated ones as well.
  const auto faces = [](const std::string& strip) {
    return parse_ply(ply_text(kZigzagHeader + strips_header("int"), kZigzag + strip)).faces;
  };
  CHECK(faces("8 0 2 1 1 3 3 2 5\n") == Faces{{0, 2, 1}, {2, 3, 5}});
  CHECK(faces("7 0 2 1 1 3 2 5\n") == Faces{{0, 2, 1}, {3, 1, 2}, {3, 2, 5}});
}

TEST_CASE("PLY strips may stand beside faces, and before the vertices", "[ply_faces]") {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string strips = strips_header("int", '2'), rows = "4 0 2 1 3\n3 3 2 5\n",
                    row = "3 2 4 5\n";
  const Faces of_strips = {{0, 2, 1}, {1, 2, 3}, {3, 2, 5}};
  Faces strips_first = of_strips, face_first = {{2, 4, 5}};
  strips_first.push_back({2, 4, 5});
  face_first.insert(face_first.end(), of_strips.begin(), of_strips.end());
  const auto faces = [](const std::string& header, const std::string& body) {
    const TriangleMesh mesh = parse_ply(ply_text(header, body));
    CHECK(mesh.has_uvs(0));
    return mesh.faces;
  };
  CHECK(faces(kZigzagHeader + face + strips, kZigzag + row + rows) == face_first);
  CHECK(faces(kZigzagHeader + strips + face, kZigzag + rows + row) == strips_first);
  CHECK(faces(strips + kZigzagHeader + face, rows + kZigzag + row) == strips_first);
  CHECK(faces(strips + face + kZigzagHeader, rows + row + kZigzag) == strips_first);
  const auto error = [](const std::string& header, const std::string& body) {
    return error_of(read_ply, "m.ply", ply_text(header, body));
  };
  CHECK(error(strips + face + kZigzagHeader, "3 0 1 2\n3 0 1 6\n" + row + kZigzag) ==
        "m.ply: tristrips: vertex index 6 is out of range (6 vertices)");
  CHECK(error(strips + face + kZigzagHeader, "3 0 1 2\n3 0 1 2\n3 0 1 7\n" + kZigzag) ==
        "m.ply: face 0: vertex index 7 is out of range (6 vertices)");
  CHECK_THAT(error(kZigzagHeader + strips, kZigzag + "2 0 1\n4 0 0 1 1\n"),
             Contains("has no faces"));
}

TEST_CASE("texture coordinates of a PLY face are two or three values a corner", "[ply_faces]") {
  for (const std::string name : {"texcoord", "texcoords", "uv", "TexCoord"}) {
    CAPTURE(name);
    const std::string property = "property list uchar float " + name + "\n";
    ReadReport report;
    const TriangleMesh two = parse_face(property, "4 0 1 2 3 8 0 0 1 0 1 .5 0 .5\n", report);
    const TriangleMesh three =
        parse_face(property, "4 0 1 2 3 12 0 0 7 1 0 7 1 .5 7 0 .5 7\n", report);
    CHECK(two.uvs == std::vector<Vec2>{{0, 0}, {1, 0}, {1, .5}, {0, .5}});
    CHECK(three.uvs == two.uvs);
    CHECK(three.face_uvs == two.face_uvs);
    CHECK_FALSE(parse_face(property, "4 0 1 2 3 0\n", report).has_uvs(0));
    CHECK(report.warnings.empty());
    CHECK(report.assumed ==
          std::vector<std::string>(2, "texture coordinates: " + name + " of the faces"));
  }
}

TEST_CASE("texture coordinates that do not fit a PLY face cost no more than its UVs",
          "[ply_faces]") {
  ReadReport report;
  const TriangleMesh mesh = parse_ply(
      ply_text(kZigzagHeader +
                   "element face 4\nproperty list uchar int vertex_indices\nproperty list uchar "
                   "float texcoord\n",
               kZigzag + "3 0 2 1 6 .1 .1 .2 .1 .1 .2\n4 1 2 3 0 6 0 0 1 0 1 1\n3 2 4 5 0\n3 2 4 5 "
                         "1 .5\n"),
      &report);
  REQUIRE(mesh.faces.size() == 5);
  CHECK(mesh.uv({0, {0, 1, 0}}) == Vec2(0.2, 0.1));
  CHECK_FALSE(mesh.has_uvs(1));
  CHECK_FALSE(mesh.has_uvs(2));
  CHECK(mesh.uv({3, {0, 1, 0}}) == Vec2(1, 0));  // the vertex's
  CHECK_FALSE(mesh.has_uvs(4));
  REQUIRE(report.warnings.size() == 1);
  CHECK(
      report.warnings[0] ==
      "m.ply: 2 faces have texture coordinates that do not fit the corners; they count as missing "
      "(the first: face 1, 6 values for 4 corners)");
  CHECK(report.assumed ==
        std::vector<std::string>{"texture coordinates: texcoord of the faces, s t of the vertices "
                                 "where there are none"});
}

TEST_CASE("a PLY texnumber comes per face, corner or vertex", "[ply_faces]") {
  using Materials = std::vector<Index>;
  const auto materials = [](const std::string& type, const std::string& values,
                            ReadReport& report) {
    return parse_face("property " + type + " texnumber\n", values, report, kThreeTextures)
        .face_materials;
  };
  ReadReport report;
  CHECK(materials("uchar", "3 0 1 2 2\n", report) == Materials{2});
  CHECK(materials("uchar", "3 0 1 2 255\n", report) == Materials{kNone});
  CHECK(materials("int", "3 0 1 2 -1\n", report) == Materials{kNone});
  CHECK(materials("list uchar int", "3 0 1 2 3 1 1 1\n", report) == Materials{1});
  CHECK(materials("list uchar int", "3 0 1 2 0\n", report) == Materials{kNone});
  CHECK(report.warnings.empty());
  CHECK(materials("list uchar int", "3 0 1 2 3 2 1 1\n", report) == Materials{2});
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("m.ply: 1 face has corners that differ in texnumber"));
  CHECK(materials("int", "3 0 1 2 3\n", report) == Materials{kNone});
  REQUIRE(report.warnings.size() == 2);
  CHECK_THAT(report.warnings[1],
             Contains("m.ply: 1 texnumber names no TextureFile and counts as none"));

  const std::string vertices = kPlyVertices + "property int texnumber\n";
  const std::string rows = "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 2\n";
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
  for (const bool faces_first : {false, true}) {
    CAPTURE(faces_first);
    report = {};
    const std::string corners = "3 0 1 2\n3 3 0 2\n";
    const std::string text = faces_first
                                 ? ply_text(kThreeTextures + faces + vertices, corners + rows)
                                 : ply_text(kThreeTextures + vertices + faces, rows + corners);
    CHECK(parse_ply(text, &report).face_materials == Materials{1, 2});
    REQUIRE(report.warnings.size() == 1);
    CHECK_THAT(report.warnings[0], Contains("1 face has corners that differ in texnumber"));
  }
  // What faces say themselves counts.
  CHECK(parse_ply(ply_text(kThreeTextures + vertices + kPlyFace + "property int texnumber\n",
                           rows + "3 0 1 3 0\n"))
            .face_materials == Materials{0});
}

TEST_CASE("without a TextureFile a PLY texnumber is ignored", "[ply_faces]") {
  ReadReport report;
  const TriangleMesh mesh = parse_face("property int texnumber\n", "3 0 1 2 5\n", report);
  CHECK(mesh.face_materials == std::vector<Index>{kNone});
  CHECK(report.warnings.empty());
  CHECK(report.ignored == std::vector<std::string>{"texnumber without a TextureFile"});
}

TEST_CASE("<this> in a PLY texture's name stands for the mesh's own", "[ply_faces]") {
  const TempFolder folder;
  folder.file("my mesh_A.png", "");
  const auto path = folder.file(
      "my mesh.ply",
      ply_text("comment TextureFile <this>_A.png\ncomment TextureFile <this>/<this>.png\n" +
                   kPlyVertices + kPlyFace,
               kPlySquare + "3 0 1 2\n"));
  ReadReport report;
  const TriangleMesh mesh = read_mesh(path, &report);
  REQUIRE(mesh.materials.size() == 2);
  CHECK(mesh.materials[0].name == "<this>_A.png");
  CHECK(mesh.materials[0].texture == (folder.path() / "my mesh_A.png").string());
  CHECK(mesh.materials[1].texture == (folder.path() / "my mesh/my mesh.png").string());
  CHECK(report.assumed == std::vector<std::string>{"<this> in TextureFile stands for my mesh"});
  CHECK(report.warnings.empty());
}
