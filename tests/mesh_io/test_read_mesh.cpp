#include "onmesh/mesh_io/read_mesh.h"

#include <catch2/catch.hpp>
#include <random>

#include "onmesh/base/error.h"
#include "support/temp_folder.h"

using namespace onmesh;
using Catch::Matchers::Contains;

namespace {

/// The mesh, or nothing if it was refused; anything but an InputError fails the test.
bool reads(const std::filesystem::path& path) {
  try {
    const TriangleMesh mesh = read_mesh(path);
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        REQUIRE(mesh.faces[f][k] < mesh.positions.size());
        REQUIRE((mesh.face_uvs[f][k] == kNone || mesh.face_uvs[f][k] < mesh.uvs.size()));
      }
      REQUIRE((mesh.face_materials[f] == kNone || mesh.face_materials[f] < mesh.materials.size()));
    }
    REQUIRE_FALSE(mesh.faces.empty());
    for (const Vec3& p : mesh.positions) REQUIRE(p.allFinite());
    for (const Vec2& uv : mesh.uvs) REQUIRE(uv.allFinite());
    return true;
  } catch (const InputError& error) {
    REQUIRE_THAT(error.what(), Contains(path.filename().string()));
    return false;
  }
}

/// One small file of every kind, by name.
std::vector<std::pair<std::string, std::string>> small_files() {
  const std::string header =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n";
  const auto raw = [](auto... values) {
    std::string out;
    (out.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
    return out;
  };
  const std::string vertices = raw(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F) +
                               raw('\4', 0, 1, 2, 3) +
                               raw('\10', 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F, 1.F);
  return {
      {"a.obj",
       "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv .2 .1 0\nvt 0 0\nvt 1 .5\nusemtl m\nf 1/1 2/2 "
       "3/2 -1/1\n"},
      {"a.ply", "ply\nformat ascii 1.0\n" + header +
                    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n"},
      {"b.ply", "ply\nformat binary_little_endian 1.0\n" + header + vertices},
      {"a.off", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"},
      {"a.stl",
       "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\n"
       "endfacet\nendsolid s\n"},
      {"b.stl", std::string(80, ' ') + raw(1U) +
                    raw(0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F) +
                    std::string(2, '\0')},
  };
}

}  // namespace

TEST_CASE("a file cut off at any byte reads as a valid mesh or is refused", "[read_mesh][slow]") {
  const TempFolder folder;
  folder.file("m.mtl", "newmtl m\nmap_Kd a.png\n");
  for (const auto& [name, content] : small_files()) {
    INFO(name);
    CHECK(reads(folder.file(name, content)));
    for (std::size_t n = 0; n < content.size(); ++n) reads(folder.file(name, content.substr(0, n)));
    // A cut inside the last element must not pass in formats that count their elements.
    if (name == "b.ply" || name == "b.stl")
      CHECK_FALSE(reads(folder.file(name, content.substr(0, content.size() - 1))));
  }
}

TEST_CASE("a file with any byte changed reads as a valid mesh or is refused", "[read_mesh][slow]") {
  const TempFolder folder;
  folder.file("m.mtl", "newmtl m\nmap_Kd a.png\n");
  std::mt19937 random(1);
  for (const auto& [name, content] : small_files()) {
    INFO(name);
    for (std::size_t i = 0; i < content.size(); ++i) {
      std::string changed = content;
      for (const char c : {'\0', '\n', '9', '-', '\xff', static_cast<char>(random())}) {
        changed[i] = c;
        reads(folder.file(name, changed));
      }
    }
  }
}

TEST_CASE("material files full of garbage never hurt", "[read_mesh][slow]") {
  const TempFolder folder;
  const auto path = folder.file("a.obj", small_files()[0].second);
  std::mt19937 random(2);
  const std::string mtl = "newmtl m\nmap_Kd -s 1 2 -mm 0 1 -o \"a b\\c.png\"\n";
  for (int i = 0; i < 300; ++i) {
    std::string changed = mtl;
    for (int k = 0; k < 4; ++k) changed[random() % changed.size()] = static_cast<char>(random());
    folder.file("m.mtl", changed.substr(0, random() % changed.size()));
    CHECK(reads(path));
  }
}

TEST_CASE("the content decides where it contradicts the extension", "[read_mesh]") {
  const TempFolder folder;
  for (const auto& [name, content] : small_files()) {
    for (const std::string other : {"x.obj", "x.ply", "x.off", "x.stl", "x", "x.dat", "x.OBJ"}) {
      INFO(name << " as " << other);
      ReadReport report;
      CHECK_FALSE(read_mesh(folder.file(other, content), &report).faces.empty());
    }
  }
  ReadReport report;
  read_mesh(folder.file("x.obj", small_files()[1].second), &report);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("read as PLY"));
}

TEST_CASE("what is no mesh is refused by the right kind of error", "[read_mesh]") {
  const TempFolder folder;
  CHECK_THROWS_AS(read_mesh(folder.path() / "missing.obj"), FileError);
  CHECK_THROWS_AS(read_mesh(folder.path()), FileError);
  CHECK_THROWS_WITH(read_mesh(folder.path()), Contains("is a folder"));
  std::filesystem::create_directory(folder.path() / "d.obj");
  CHECK_THROWS_AS(read_mesh(folder.path() / "d.obj"), FileError);
  CHECK_THROWS_AS(read_mesh(folder.path() / "missing.obj" / "x"), FileError);

  std::mt19937 random(3);
  std::string noise;
  for (int i = 0; i < 5000; ++i) noise += static_cast<char>(random());
  for (const std::string extension : {".obj", ".ply", ".off", ".stl", ".glb", ""}) {
    for (const std::string& content :
         {noise, std::string("\x89PNG\r\n\x1a\n\0\0", 10), std::string("hello\n"), std::string()}) {
      CHECK_THROWS_AS(read_mesh(folder.file("n" + extension, content)), InputError);
    }
  }
  CHECK_THROWS_WITH(read_mesh(folder.file("n.glb", "glTF")), Contains("byte 4: the file ends"));
  CHECK_THROWS_WITH(read_mesh(folder.file("n.fbx", "Kaydara")), Contains("OFF, STL or glTF"));
}
