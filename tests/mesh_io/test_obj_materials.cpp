// Material files as people bring them, through read_mesh().
#include "onmesh/mesh_io/obj_materials.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/read_mesh.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

const std::string kOneSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

/// A folder with an OBJ of one face per material.
struct Model {
  std::string read(const std::string& head, const std::vector<std::string>& materials,
                   const ReadOptions& options = {}) {
    std::string text = head + kOneSquare;
    for (const std::string& material : materials)
      text += "usemtl " + material + "\nf 1/1 2/2 3/3\n";
    report = {};
    mesh = read_mesh(folder.file("m.obj", text), &report, options);
    return mesh.materials.empty() ? std::string() : texture(0);
  }
  /// The file name of a material's texture.
  std::string texture(std::size_t material) const {
    return fs::path(mesh.materials.at(material).texture).filename().string();
  }
  std::string warnings() const {
    std::string text;
    for (const std::string& warning : report.warnings) text += warning + "\n";
    return text;
  }
  TempFolder folder;
  TriangleMesh mesh;
  ReadReport report;
};

TEST_CASE("a comment behind the name of a material file or material is none of it",
          "[obj_materials]") {
  Model model;
  model.folder.file("a b.mtl", "newmtl Red # c\nmap_Kd x.png # c\nnewmtl # Hash\nmap_Kd y.png\n");
  model.folder.file("x.png", "");
  CHECK(model.read("mtllib a b.mtl # c\n", {"Red # d", "Red", "# Hash"}) == "x.png");
  CHECK(model.report.warnings.empty());
  REQUIRE(model.mesh.materials.size() == 2);
  CHECK(model.mesh.materials[0].name == "Red");
  CHECK(model.mesh.face_materials == std::vector<Index>{0, 0, 1});
  CHECK(model.texture(1) == "y.png");
}

TEST_CASE("a name that really holds a number sign goes before one that is cut there",
          "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl # 1", "newmtl m\nmap_Kd wanted.png # 2\nnewmtl m # b\nmap_Kd b.png\n");
  model.folder.file("a.mtl", "newmtl m\nmap_Kd wrong.png\n");
  model.folder.file("wanted.png # 2", "");
  model.folder.file("wanted.png", "");
  CHECK(model.read("mtllib a.mtl # 1\n", {"m", "m # b"}) == "wanted.png # 2");
  CHECK(model.texture(1) == "b.png");
}

TEST_CASE("a line may name several material files, with blanks in their names", "[obj_materials]") {
  Model model;
  model.folder.file("a b.mtl", "newmtl m\nmap_Kd ab.png\n");
  model.folder.file("c.MTL", "newmtl n\nmap_Kd c.png\n");
  model.folder.file("plain", "newmtl o\nmap_Kd o.png\n");
  CHECK(model.read("mtllib a b.mtl c.MTL\n", {"m", "n"}) == "ab.png");
  CHECK(model.texture(1) == "c.png");
  CHECK(model.read("mtllib plain c.MTL # both\n", {"o", "n"}) == "o.png");
  CHECK(model.texture(1) == "c.png");
  CHECK(model.report.warnings.empty());
}

TEST_CASE("a material file that is elsewhere than named is found beside the OBJ",
          "[obj_materials]") {
  Model model;
  model.folder.file("lib.mtl", "newmtl m\nmap_Kd a.png\n");
  for (const char* name : {"resources/lib.mtl", "..\\x\\lib.mtl", "C:\\my files\\lib.mtl",
                           "/nowhere/lib.mtl", "LIB.mtl"}) {
    INFO(name);
    CHECK(model.read(std::string("mtllib ") + name + "\n", {"m"}) == "a.png");
  }
}

TEST_CASE("where no material file is found the one of the OBJ's name is assumed",
          "[obj_materials]") {
  Model model;
  CHECK(model.read("mtllib lost.mtl\n", {"m"}).empty());
  CHECK_THAT(model.warnings(), Contains("lost.mtl: cannot open") &&
                                   Contains("no material file defines 'm', which faces use"));
  CHECK(model.read("", {"m"}).empty());
  CHECK_THAT(model.warnings(), Contains("no material file defines 'm'"));
  model.folder.file("m.mtl", "newmtl m\nmap_Kd a.png\n");
  CHECK(model.read("mtllib lost.mtl\n", {"m"}) == "a.png");
  CHECK_THAT(model.warnings(),
             Contains("lost.mtl: cannot open") && Contains("m.mtl is assumed to define"));
  CHECK(model.read("", {"m"}) == "a.png");
  CHECK_THAT(model.warnings(), Contains("m.mtl is assumed to define"));
  // Nobody asked for materials.
  model.read("", {""});
  CHECK(model.report.warnings.empty());
}

TEST_CASE("materials that nothing defines are named, eight of them", "[obj_materials]") {
  Model model;
  std::vector<std::string> names;
  for (int i = 0; i < 11; ++i) names.push_back("m" + std::to_string(i));
  model.folder.file("a.mtl", "newmtl m3\n");
  model.read("mtllib a.mtl\nusemtl not used\n", names);
  REQUIRE(model.report.warnings.size() == 1);
  CHECK_THAT(model.report.warnings[0],
             Contains("'m0', 'm1', 'm2', 'm4', 'm5', 'm6', 'm7', 'm8' and 2 more"));
}

TEST_CASE("a material in the other case of letters is taken if only one fits", "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl", "newmtl skin\nmap_Kd a.png\nnewmtl x\nnewmtl X\n");
  CHECK(model.read("mtllib a.mtl\n", {"SKIN"}) == "a.png");
  CHECK(model.mesh.materials[0].name == "SKIN");
  REQUIRE(model.report.warnings.size() == 1);
  CHECK_THAT(model.report.warnings[0], Contains("'SKIN'") && Contains("'skin'"));
  model.folder.file("b.mtl", "newmtl skin\nmap_Kd a.png\nnewmtl Skin\nmap_Kd b.png\n");
  CHECK(model.read("mtllib b.mtl\n", {"SKIN", "Skin"}).empty());
  CHECK(model.texture(1) == "b.png");
}

TEST_CASE("of two materials of one name the first texture counts, and info is told",
          "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl",
                    "newmtl m\nKd 1 1 1\nnewmtl m\nmap_Kd a.png\nmap_Kd b.png\nnewmtl m\n");
  CHECK(model.read("mtllib a.mtl\n", {"m"}) == "a.png");
  CHECK(model.report.warnings.empty());
  REQUIRE(model.report.assumed.size() == 1);
  CHECK_THAT(model.report.assumed[0], Contains("'m'") && Contains("its first texture counts"));
}

TEST_CASE("a texture's scale and offset move the UVs of its material alone", "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl",
                    "newmtl plain\nmap_Kd a.png\n"
                    "newmtl moved\nmap_Kd -s 2 3 -o 0.5 -1 a.png\n"
                    "newmtl lost\nmap_Kd -s inf 1 a.png\n");
  model.read("mtllib a.mtl\n", {"plain", "moved", "lost"});
  const auto uvs = [&](Index face) { return model.mesh.corner_uvs(face); };
  CHECK(uvs(0) == std::array<Vec2, 3>{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)});
  CHECK(uvs(1) == std::array<Vec2, 3>{Vec2(0.5, -1), Vec2(2.5, -1), Vec2(2.5, 2)});
  CHECK_FALSE(model.mesh.has_uvs(2));
  REQUIRE(model.report.warnings.size() == 1);
  CHECK_THAT(model.report.warnings[0], Contains("texture coordinates are not finite"));
}

TEST_CASE("materials say how they are read beyond the tile", "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl",
                    "newmtl a\nmap_Kd -clamp on a.png\nnewmtl b\nmap_Kd -clamp off a.png\n"
                    "newmtl c\nmap_Kd a.png\n");
  model.read("mtllib a.mtl\n", {"a", "b", "c"});
  CHECK(model.mesh.materials[0].wrap == WrapModes(Wrap::clamp));
  CHECK(model.mesh.materials[1].wrap == WrapModes(Wrap::repeat));
  CHECK_FALSE(model.mesh.materials[2].wrap);
}

TEST_CASE("options that are not followed are warned about once per file and option",
          "[obj_materials]") {
  Model model;
  model.folder.file("a.mtl",
                    "newmtl a\nmap_Kd -mm 0 2 -bm 1 a.png\nnewmtl b\nmap_Kd -mm 0 3 a.png\n"
                    "newmtl unused\nmap_Kd -cc on a.png\nmap_Ks s.png\n");
  model.read("mtllib a.mtl\n", {"a", "b"});
  REQUIRE(model.report.warnings.size() == 1);
  CHECK_THAT(model.report.warnings[0],
             Contains("a.mtl: material 'a': -mm '0' '2' of map_Kd is not followed (nor that of 1 "
                      "other material)"));
  REQUIRE(model.report.ignored.size() == 1);
  CHECK_THAT(model.report.ignored[0], Contains("1 map_Ks of ") && Contains("a.mtl"));
}

TEST_CASE("a confined OBJ names nothing outside its folder", "[obj_materials]") {
  Model model;
  ReadOptions confined;
  confined.confine = true;
  model.folder.file("a.mtl", "newmtl m\nmap_Kd ../a.png\n");
  CHECK_THROWS_WITH(model.read("mtllib a.mtl\n", {"m"}, confined),
                    Contains("a.mtl: '../a.png' lies outside"));
  CHECK_THROWS_WITH(model.read("mtllib ../a.mtl\n", {"m"}, confined),
                    Contains("m.obj: '../a.mtl' lies outside"));
}

}  // namespace
}  // namespace onmesh
