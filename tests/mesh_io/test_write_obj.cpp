#include "onmesh/mesh_io/write_obj.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/mesh_io/read_mesh.h"
#include "support/temp_folder.h"

using namespace onmesh;

TEST_CASE("a written OBJ reads back bit for bit", "[write_obj]") {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path() / "tex");
  folder.file("tex/a b.png", "");
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-10, 10);
  TriangleMesh mesh;
  for (int i = 0; i < 300; ++i) {
    mesh.positions.emplace_back(uniform(random), uniform(random) * 1e-200, uniform(random) * 1e100);
    mesh.uvs.emplace_back(uniform(random), 1 / uniform(random));
  }
  mesh.positions[0] = {-0.0, 5e-324, 1.7976931348623157e308};
  mesh.materials = {
      {"a b", (folder.path() / "tex/a b.png").string()}, {"", ""}, {"a b", ""}, {" c\nd ", ""}};
  for (Index i = 0; i < 298; ++i) {
    mesh.faces.push_back({i, i + 1, i + 2});
    mesh.face_uvs.push_back({i + 2, i % 5 == 0 ? kNone : i, i + 1});
    mesh.face_materials.push_back(i < 4 ? i : i % 7 == 0 ? kNone : i % 3);
  }
  mesh.normals = {{0, 0, 1}, {1e-300, -0.1, 3}};
  mesh.face_normals.assign(298, {kNone, 1, 0});
  const auto path = folder.path() / "out.obj";
  write_obj(path, mesh);
  ReadReport report;
  const TriangleMesh back = read_mesh(path, &report);
  CHECK(report.warnings.empty());
  REQUIRE(back.positions.size() == mesh.positions.size());
  for (std::size_t i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k)
      CHECK(std::signbit(back.positions[i][k]) == std::signbit(mesh.positions[i][k]));
  }
  CHECK(back.positions == mesh.positions);
  CHECK(back.uvs == mesh.uvs);
  CHECK(back.faces == mesh.faces);
  CHECK(back.face_uvs == mesh.face_uvs);
  CHECK(back.face_materials == mesh.face_materials);
  CHECK(back.normals == mesh.normals);
  CHECK(back.face_normals == mesh.face_normals);
  REQUIRE(back.materials.size() == 4);
  CHECK(back.materials[0].texture == mesh.materials[0].texture);
  CHECK(back.materials[2].texture.empty());
  // Nothing but the two files is left.
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 3);
}

TEST_CASE("a material that is clamped stays so in an OBJ", "[write_obj]") {
  const TempFolder folder;
  folder.file("t.png", "");
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::string texture = (folder.path() / "t.png").string();
  mesh.materials = {{"a", texture, Wrap::clamp}, {"b", texture, Wrap::mirror}, {"c", texture}};
  for (Index m = 0; m < 3; ++m) {
    mesh.faces.push_back({0, 1, 2});
    mesh.face_uvs.push_back({kNone, kNone, kNone});
    mesh.face_materials.push_back(m);
  }
  write_obj(folder.path() / "out.obj", mesh);
  const TriangleMesh back = read_mesh(folder.path() / "out.obj");
  REQUIRE(back.materials.size() == 3);
  CHECK(back.materials[0].wrap == WrapModes(Wrap::clamp));
  CHECK_FALSE(back.materials[1].wrap);  // MTL has no word for it
  CHECK_FALSE(back.materials[2].wrap);
  CHECK(back.materials[0].texture == texture);
}

TEST_CASE("names that an OBJ would take for something else keep their faces", "[write_obj]") {
  const TempFolder folder;
  folder.file("-s 1.png", "");
  folder.file("#1.png", "");
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.materials = {{"ends with a backslash\\", (folder.path() / "-s 1.png").string()},
                    {"ends with a backslash\\_", (folder.path() / "#1.png").string()},
                    {"\\", ""},
                    {"# no comment", ""}};
  for (Index m = 0; m < 4; ++m) {
    mesh.faces.push_back({0, 1, 2});
    mesh.face_uvs.push_back({kNone, kNone, kNone});
    mesh.face_materials.push_back(m);
  }
  for (const char* name : {"out.obj", "-out.obj", "# out.obj"}) {
    INFO(name);
    write_obj(folder.path() / name, mesh);
    ReadReport report;
    const TriangleMesh back = read_mesh(folder.path() / name, &report);
    CHECK(report.warnings.empty());
    CHECK(back.faces.size() == 4);
    CHECK(back.face_materials == mesh.face_materials);
    REQUIRE(back.materials.size() == 4);
    CHECK(back.materials[0].texture == mesh.materials[0].texture);
    CHECK(back.materials[1].texture == mesh.materials[1].texture);
    CHECK(back.materials[3].name == mesh.materials[3].name);
  }
}
