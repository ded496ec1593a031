#include "onmesh/mesh_io/ply_header.h"

#include <catch2/catch.hpp>

#include "support/ply_files.h"

using namespace onmesh;
using Catch::Matchers::StartsWith;

namespace {

PlyHeader header_of(const std::string& lines) {
  return read_ply_header("ply\n" + lines + "end_header\n", "m.ply");
}

}  // namespace

TEST_CASE("PLY header lines may end in any way, have blanks and capitals", "[ply_header]") {
  const std::string text =
      "\xef\xbb\xbfPLY \r\nFORMAT\tASCII  1.0\r  Comment x\nElement vertex 4\t\r\nproperty FLOAT "
      "x\rproperty Float32 y \nProperty double z\nelement face 1\nproperty LIST uChar Int "
      "vertex_indices\nEND_HEADER\r\n";
  const PlyHeader header = read_ply_header(text, "m.ply");
  CHECK(header.format == PlyFormat::ascii);
  CHECK(header.version == "1.0");
  CHECK(header.lines == 10);
  CHECK(header.size == text.size());
  CHECK(header.stray_lines == 0);
  REQUIRE(header.elements.size() == 2);
  REQUIRE(header.elements[0].properties.size() == 3);
  CHECK(header.elements[0].properties[1].type == PlyType::f32);
  CHECK(header.elements[1].properties[0].count == PlyType::u8);
  CHECK(parse_ply(text + kPlySquare + "3 0 1 2\n").faces.size() == 1);
}

TEST_CASE("stray PLY header lines are skipped with one warning", "[ply_header]") {
  ReadReport report;
  const TriangleMesh mesh =
      parse_ply("ply\nformat ascii 1.0\nauthor me\n" + kPlyVertices + "\nobject square\n" +
                    kPlyFace + "end_header\n" + kPlySquare + "3 0 1 2\n",
                &report);
  CHECK(mesh.faces.size() == 1);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], StartsWith("m.ply:3: 3 header lines are blank or of no known"));

  report = {};
  parse_ply(ply_text(kPlyVertices + kPlyFace + "\n", kPlySquare + "3 0 1 2\n"), &report);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], StartsWith("m.ply:9: 1 header line is blank"));
}

TEST_CASE("PLY comments name textures in several spellings", "[ply_header]") {
  const PlyHeader header = header_of(
      "format ascii 1.0\ncomment TextureFile a b.png \ncomment texturefile b.png\nobj_info "
      "TextureFile c.png\ncomment TextureFile: d.png\ncomment TextureFile : e.png\ncomment Texture "
      "f.png\ncomment TextureFileName g.png\ncomment TextureFile C:\\h.png\n");
  CHECK(header.textures ==
        std::vector<std::string>{"a b.png", "b.png", "c.png", "d.png", "e.png", "C:\\h.png"});
}
