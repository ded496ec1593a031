#include "onmesh/mesh_io/read_ply.h"

#include <catch2/catch.hpp>

#include "onmesh/mesh_io/read_mesh.h"
#include "support/ply_files.h"
#include "support/refused.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Face = std::array<Index, 3>;

namespace {

std::string error_of(const std::string& content) {
  return onmesh::error_of(read_ply, "m.ply", content);
}

}  // namespace

TEST_CASE("a PLY file reads the same as text and in both byte orders", "[read_ply]") {
  // Foreign elements and properties of every type around what is wanted.
  const std::string elements =
      "comment made by hand\nobj_info nothing\nelement first 2\nproperty list ushort short "
      "junk\nproperty double d\n"
      "element vertex 4\nproperty uchar red\nproperty double x\nproperty float32 y\nproperty int16 "
      "z\n"
      "property list uint8 float weights\nproperty float s\nproperty float t\n"
      "element face 2\nproperty uint id\nproperty list int uint vertex_index\nproperty char flag\n"
      "element last 1\nproperty ushort end\n";
  const std::vector<TriangleMesh> meshes = [&] {
    std::vector<TriangleMesh> result;
    result.push_back(parse_ply(ply_text(
        elements,
        "2 5 6 0.5\n0 0.25\n1 0 0 0 0 0 0\n2 1.5 0 0 1 7 1 0\n3 1.5 1 -2 0 1 1\n4 0 1 0 2 8 9 0 1\n"
        "7 3 0 1 2 -1\n8 4 0 1 2 3 1\n65535\n")));
    for (const bool big : {false, true}) {
      PlyBytes b(big);
      b.add<std::uint16_t>(2)
          .add<std::int16_t>(5)
          .add<std::int16_t>(6)
          .add(0.5)
          .add<std::uint16_t>(0)
          .add(0.25);
      const auto vertex = [&](double x, float y, std::int16_t z, std::uint8_t weights, float s,
                              float t) {
        b.add<std::uint8_t>(1).add(x).add(y).add(z).add(weights);
        for (int i = 0; i < weights; ++i) b.add(7.F);
        b.add(s).add(t);
      };
      vertex(0, 0, 0, 0, 0, 0);
      vertex(1.5, 0, 0, 1, 1, 0);
      vertex(1.5, 1, -2, 0, 1, 1);
      vertex(0, 1, 0, 2, 0, 1);
      b.add(7U).add(3).add(0U).add(1U).add(2U).add<std::int8_t>(-1);
      b.add(8U).add(4).add(0U).add(1U).add(2U).add(3U).add<std::int8_t>(1);
      b.add<std::uint16_t>(65535);
      const std::string format = big ? "binary_big_endian" : "binary_little_endian";
      result.push_back(
          parse_ply("ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + b.text));
    }
    return result;
  }();
  for (const TriangleMesh& mesh : meshes) {
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1.5, 0, 0}, {1.5, 1, -2}, {0, 1, 0}});
    CHECK(mesh.uvs == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    REQUIRE(mesh.faces.size() == 3);
    CHECK(mesh.faces[0] == Face{0, 1, 2});
    CHECK(mesh.face_uvs == mesh.faces);
    CHECK(mesh.faces == meshes[0].faces);
    CHECK(mesh.face_materials == std::vector<Index>{kNone, kNone, kNone});
  }
}

TEST_CASE("PLY UVs come under several names, or per corner with a texture number", "[read_ply]") {
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::string elements =
        kPlyVertices + "property float " + u + "\nproperty float " + v + "\n" + kPlyFace;
    const TriangleMesh mesh =
        parse_ply(ply_text(elements, "0 0 0 .5 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2\n"));
    CHECK(mesh.uvs[0] == Vec2(0.5, 0));
    CHECK(mesh.has_uvs(0));
  }
  const TempFolder folder;
  folder.file("a b.png", "");
  const auto path = folder.file(
      "m.ply",
      ply_text("comment TextureFile a b.png\ncomment TextureFile c.png\n" + kPlyVertices +
                   "element face 4\nproperty list uchar int vertex_indices\nproperty list "
                   "uchar float texcoord\n"
                   "property int texnumber\n",
               kPlySquare + "4 0 1 2 3 8 0 0 .5 0 .5 .5 0 .5 1\n3 0 1 2 0 0\n3 0 1 2 6 0 0 1 0 "
                            "nan 1 -1\n3 2 1 0 6 .1 .2 .3 .4 .5 .6 0\n"));
  ReadReport report;
  const TriangleMesh mesh = read_mesh(path, &report);
  REQUIRE(mesh.faces.size() == 5);
  CHECK(mesh.face_materials == std::vector<Index>{1, 1, 0, kNone, 0});
  CHECK(mesh.materials[0].texture == (folder.path() / "a b.png").string());
  CHECK(mesh.materials[1].texture == (folder.path() / "c.png").string());
  CHECK(mesh.uv({1, {0, 0, 1}}) == Vec2(0, 0.5));
  CHECK_FALSE(mesh.has_uvs(2));
  CHECK_FALSE(mesh.has_uvs(3));
  CHECK(mesh.uv({4, {1, 0, 0}}) == Vec2(0.1, 0.2));
  CHECK(report.warnings.size() == 1);
}

TEST_CASE("a PLY file may have its faces before its vertices", "[read_ply]") {
  const std::string elements = kPlyFace + kPlyVertices + "property float u\nproperty float v\n";
  const std::string vertices = "0 0 0 .5 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n";
  const TriangleMesh mesh = parse_ply(ply_text(elements, "3 0 1 3\n" + vertices));
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 3}});
  CHECK(mesh.uv({0, {1, 0, 0}}) == Vec2(0.5, 0));
  CHECK(error_of(ply_text(elements, "3 0 1 4\n" + vertices)) ==
        "m.ply: face 0: vertex index 4 is out of range (4 vertices)");
}

TEST_CASE("a bad PLY file is refused", "[read_ply]") {
  const auto body = [](const std::string& text) {
    return error_of(ply_text(kPlyVertices + kPlyFace, text));
  };
  CHECK(body(kPlySquare + "3 0 1 2\n") == "no error");
  CHECK(body(kPlySquare + "3 0 1 4\n") ==
        "m.ply:14: face 0: vertex index 4 is out of range (4 vertices)");
  CHECK_THAT(body(kPlySquare + "3 0 1 -1\n"), Contains("face 0: vertex index is negative"));
  CHECK_THAT(body(kPlySquare + "3 0 1 1.5\n"), Contains("face 0: vertex index"));
  CHECK_THAT(body(kPlySquare + "3 0 1 nan\n"), Contains("face 0: vertex index"));
  CHECK_THAT(body(kPlySquare + "2 0 1\n"), Contains("at least 3 corners"));
  CHECK_THAT(body(kPlySquare + "-3 0 1 2\n"), Contains("impossible length"));
  CHECK_THAT(body(kPlySquare + "nan 0 1 2\n"), Contains("impossible length"));
  CHECK_THAT(body(kPlySquare + "2000000000 0 1 2\n"), Contains("longer than the file"));
  CHECK_THAT(body(kPlySquare + "3 0 1\n"), Contains("file ends before"));
  CHECK_THAT(body("0 0 0\n1 0 zero\n1 1 0\n0 1 0\n3 0 1 2\n"),
             StartsWith("m.ply:11: value is not a number: 'zero'"));
  CHECK_THAT(body("0 0 0\n1 0 nan\n1 1 0\n0 1 0\n3 0 1 2\n"),
             Contains("vertex 1: has a coordinate that is not finite"));

  const std::string good = ply_text(kPlyVertices + kPlyFace, kPlySquare + "3 0 1 2\n");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return error_of(text.replace(text.find(from), from.size(), to));
  };
  CHECK_THAT(changed("ply\n", "pla\n"), StartsWith("m.ply:1: is not a PLY"));
  CHECK_THAT(changed("end_header\n", ""), Contains("header has no end_header"));
  CHECK_THAT(error_of("ply\nformat ascii 1.0\n" + kPlyVertices), Contains("no end_header"));
  CHECK_THAT(changed("format ascii 1.0\n", ""), Contains("no format"));
  CHECK_THAT(changed("format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n"),
             Contains("m.ply:3: header has a second format"));
  CHECK_THAT(changed("element face", "element vertex"), Contains("has two elements 'vertex'"));
  CHECK_THAT(changed("ascii", "ebcdic"), Contains("m.ply:2: unknown format 'ebcdic'"));
  CHECK_THAT(changed("property float x", "property half x"),
             Contains("m.ply:4: unknown type 'half'"));
  CHECK_THAT(changed("list uchar", "list float"), Contains("no integer type"));
  CHECK_THAT(changed("element vertex 4", "element vertex -4"),
             Contains("m.ply:3: element count is not a number: '-4'"));
  CHECK_THAT(changed("element vertex 4", "element vertex 99999999999999999999"),
             Contains("element count"));
  for (const std::string huge : {"4000000000", "18446744073709551615"}) {
    CHECK_THAT(changed("vertex 4", "vertex " + huge), Contains("too short"));
    CHECK_THAT(changed("face 1", "face " + huge), Contains("too short"));
  }
  CHECK_THAT(changed("property float y", "property float w"), Contains("no y"));
  CHECK_THAT(changed("vertex_indices", "indices"), Contains("no list vertex_indices"));
  CHECK_THAT(error_of(ply_text(kPlyVertices, kPlySquare)), Contains("no faces"));
  CHECK_THAT(error_of(ply_text(kPlyFace, "3 0 1 2\n")), Contains("no vertices"));
  CHECK_THAT(
      error_of(ply_text(kPlyVertices + "element face 0\nproperty list uchar int vertex_indices\n",
                        kPlySquare)),
      Contains("no faces"));
}

TEST_CASE("a binary PLY file that ends early names the element that is cut off", "[read_ply]") {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char "
      "y\nproperty char z\nelement face 2\nproperty list uchar uchar vertex_indices\nend_header\n";
  const std::string body("\0\0\0\1\0\0\0\1\0\3\0\1\2\3\0\1\2", 17);
  CHECK(error_of(header + body) == "no error");
  CHECK(error_of(header + body.substr(0, 16)) ==
        "m.ply: face 1: list 'vertex_indices' is longer than the file");
  CHECK(error_of(header + body.substr(0, 13)) ==
        "m.ply: face 1: file ends before all its elements");
  CHECK(error_of(header + body.substr(0, 12) + "\3") ==
        "m.ply: face 0: vertex index 3 is out of range (3 vertices)");
}

TEST_CASE("what a PLY file holds is reported in the words of the format", "[read_ply]") {
  ReadReport report;
  parse_ply(
      ply_text("comment TextureFile a.png\nelement empty 0\n" + kPlyVertices +
                   "property float nx\nproperty float ny\nproperty float nz\nproperty uchar "
                   "red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n" +
                   kPlyFace + "property int flags\nelement edge 1\nproperty int vertex1\n",
               "0 0 0 0 0 1 9 9 9 .5\n1 0 0 0 0 1 9 9 9 .5\n1 1 0 0 0 1 9 9 9 .5\n0 1 0 0 0 1 "
               "9 9 9 .5\n3 0 1 2 7\n0\nmore\n"),
      &report);
  CHECK(report.read ==
        std::vector<std::string>{"format ascii 1.0", "TextureFile a.png", "4 vertex", "1 face"});
  CHECK(report.ignored == std::vector<std::string>{"0 empty", "vertex: normals nx ny nz",
                                                   "vertex: colours red green blue",
                                                   "vertex: quality", "face: flags", "1 edge",
                                                   "5 bytes behind the last element"});
  CHECK(report.assumed.empty());
  CHECK(report.warnings.empty());
}
