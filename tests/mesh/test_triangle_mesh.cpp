#include "onmesh/mesh/triangle_mesh.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/small_meshes.h"

using namespace onmesh;
using Face = std::array<Index, 3>;

TEST_CASE("a surface point interpolates position and UV", "[triangle_mesh]") {
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {2, 0, 0}, {0, 2, 4}}, {{0, 1, 2}});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.face_uvs = {{2, 1, 0}};
  CHECK(mesh.position({0, {0.25, 0.25, 0.5}}).isApprox(Vec3(0.5, 1, 2)));
  CHECK(mesh.uv({0, {0.25, 0.25, 0.5}}).isApprox(Vec2(0.25, 0.25)));
  CHECK(mesh.face_area(0) == Approx(std::sqrt(20.0)));
}

TEST_CASE("edges count once and unused vertices not at all", "[triangle_mesh]") {
  const TriangleMesh square =
      bare_mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{1, 2, 3}, {1, 3, 4}});
  CHECK(square.mean_edge_length() == Approx((4 + std::sqrt(2.0)) / 5));
  CHECK(square.diagonal() == Approx(std::sqrt(2.0)));
  CHECK(bare_mesh({}, {}).mean_edge_length() == 0);
  CHECK(bare_mesh({}, {}).diagonal() == 0);
}

TEST_CASE("welding joins what is equal bit by bit, and only that", "[triangle_mesh]") {
  const double next = std::nextafter(1.0, 2.0);
  TriangleMesh mesh =
      bare_mesh({{7, 7, 7}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -0.0, 0}, {0, 1, 0}, {next, 1, 0}},
                {{1, 2, 3}, {5, 4, 6}});
  mesh.uvs = {{5, 5}, {0, 0}, {1, 0}, {-0.0, 0}};
  mesh.face_uvs = {{1, 2, kNone}, {3, 2, 2}};
  const TriangleMesh welded = weld(mesh);
  CHECK(welded.positions.size() == 4);
  CHECK(welded.faces == std::vector<Face>{{0, 1, 2}, {2, 1, 3}});
  CHECK(welded.uvs.size() == 2);
  CHECK(welded.face_uvs == std::vector<Face>{{0, 1, kNone}, {0, 1, 1}});
  const TriangleMesh again = weld(welded);
  CHECK(again.positions == welded.positions);
  CHECK(again.faces == welded.faces);
  CHECK(again.uvs == welded.uvs);
  CHECK(again.face_uvs == welded.face_uvs);
}

TEST_CASE("normals stay with their corners", "[triangle_mesh]") {
  TriangleMesh mesh =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {3, 2, 1}, {1, 2, 3}});
  mesh.normals = {{9, 9, 9}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  mesh.face_normals = {{1, 2, kNone}, {3, 3, 4}, {4, 4, 4}};
  const auto normals_of = [](const TriangleMesh& m) {
    std::vector<std::array<double, 3>> sums;  // a normal per corner told by a number
    for (const auto& face : m.face_normals) {
      sums.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        sums.back()[k] = face[k] == kNone ? -1 : m.normals[face[k]].dot(Vec3(1, 10, 100));
      }
    }
    return sums;
  };
  const auto before = normals_of(mesh);
  const TriangleMesh welded = weld(mesh);
  CHECK(normals_of(welded) == before);
  CHECK(welded.normals.size() == 4);  // without the one that no face has
  CHECK(normals_of(loosen(mesh)) == before);
  CHECK(loosen(mesh).normals.size() == 8);
  mesh.materials = {{"a", {}}, {"b", {}}};
  mesh.face_materials = {0, 1, 0};
  CHECK(normals_of(separate_materials(mesh)) == before);
  const TriangleMesh part = extract_faces(mesh, {false, true, false});
  CHECK(normals_of(part) == decltype(before){before[1]});
  CHECK(part.normals.size() == 2);
}

TEST_CASE("a mesh of loose triangles welds to the mesh it was cut from", "[triangle_mesh]") {
  constexpr Index n = 30;
  TriangleMesh loose = bare_mesh({}, {});
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const auto at = [](Index x, Index y) {
        return Vec3(x * 0.1, y / 3.0, std::sin(x + 2.0 * y));
      };
      for (const auto& corner :
           {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)}) {
        loose.positions.push_back(corner);
      }
    }
  }
  for (Index f = 0; f < 2 * n * n; ++f) {
    loose.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    loose.face_uvs.push_back({kNone, kNone, kNone});
    loose.face_materials.push_back(kNone);
  }
  const TriangleMesh welded = weld(loose);
  CHECK(welded.positions.size() == (n + 1) * (n + 1));
  for (Index f = 0; f < loose.faces.size(); ++f) CHECK(welded.corners(f) == loose.corners(f));
}

TEST_CASE("a loosened mesh welds to what it was", "[triangle_mesh]") {
  TriangleMesh mesh = corner_tetrahedron();
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.face_uvs = mesh.faces;
  mesh.face_uvs[2][1] = kNone;
  const TriangleMesh loose = loosen(mesh);
  CHECK(loose.positions.size() == 12);
  CHECK(loose.uvs.size() == 11);
  const TriangleMesh welded = weld(loose);
  CHECK(welded.positions.size() == 4);
  CHECK(welded.uvs.size() == 4);
  for (Index f = 0; f < 4; ++f) CHECK(welded.corners(f) == mesh.corners(f));
  CHECK(welded.face_uvs[2][1] == kNone);
}

TEST_CASE("extracted faces keep their corners", "[triangle_mesh]") {
  TriangleMesh mesh = corner_tetrahedron();
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.face_uvs = mesh.faces;
  const TriangleMesh part = extract_faces(mesh, {false, false, true, false});
  REQUIRE(part.faces.size() == 1);
  CHECK(part.positions.size() == 3);
  CHECK(part.uvs.size() == 3);
  CHECK(part.corners(0) == mesh.corners(2));
  CHECK(part.corner_uvs(0) == mesh.corner_uvs(2));
}
