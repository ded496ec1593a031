// Faces on the same three vertices: repeats go, layers become sheets of their own.
#include "onmesh/mesh/coincident_faces.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "onmesh/measure/mesh_report.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/procedural/shapes.h"
#include "support/rewritten_meshes.h"
#include "support/small_meshes.h"

namespace onmesh {
namespace {

/// Every face a second time, wound the other way, with UVs of its own.
TriangleMesh two_sided(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  const auto shift = Index(mesh.uvs.size());
  for (const Vec2& uv : mesh.uvs) result.uvs.push_back(uv + Vec2(2, 0));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& v = mesh.faces[f];
    const auto& u = mesh.face_uvs[f];
    add_face(result, {v[0], v[2], v[1]}, {u[0] + shift, u[2] + shift, u[1] + shift});
  }
  return result;
}

TEST_CASE("a two-sided flag becomes two sheets, in whatever order its faces come",
          "[coincident_faces]") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    TriangleMesh flag = two_sided(make_plane(4, 3));
    shuffle_faces(flag, seed);
    CleanReport report;
    const TriangleMesh cleaned = clean(flag, &report);
    CHECK(report.duplicates == 0);
    CHECK(report.separated == 24);
    CHECK(report.flipped == 0);
    CHECK(report.manifold());
    CHECK(cleaned.faces.size() == 48);
    CHECK(cleaned.positions.size() == 2 * 5 * 4);
    const MeshReport r = report_mesh(cleaned);
    CHECK(r.components == 2);
    CHECK(r.duplicate_faces == 0);
    // Each component has the faces of one side.
    std::set<std::pair<Index, bool>> sides;
    for (Index f = 0; f < 48; ++f) {
      sides.emplace(r.component_of_face[f], cleaned.corner_uvs(f)[0].x() > 1.5);
    }
    CHECK(sides.size() == 2);
  }
}

TEST_CASE("front faces stay one sheet across seams of their atlas", "[coincident_faces]") {
  TriangleMesh flag = two_sided(make_plane(2, 1));
  // Each face with UVs of its own: nothing but the winding tells front from back.
  flag = loosen(flag);
  for (std::size_t i = 0; i < flag.uvs.size(); ++i) flag.uvs[i] += Vec2(0, 3.0 * double(i / 3));
  CleanReport report;
  const TriangleMesh cleaned = clean(weld(flag), &report);
  CHECK(report.manifold());
  CHECK(report_mesh(cleaned).components == 2);
}

TEST_CASE("copies with the same texels are dropped, those without texels give way",
          "[coincident_faces]") {
  TriangleMesh mesh = make_plane(1, 1);
  const auto faces = mesh.faces, uvs = mesh.face_uvs;
  add_face(mesh, {faces[0][1], faces[0][2], faces[0][0]}, {uvs[0][1], uvs[0][2], uvs[0][0]});
  add_face(mesh, {faces[0][2], faces[0][1], faces[0][0]}, {uvs[0][2], uvs[0][1], uvs[0][0]});
  add_face(mesh, faces[1], {kNone, kNone, kNone});
  mesh.face_uvs[1] = {0, 0, 0};  // without area
  add_face(mesh, faces[1], uvs[1]);
  CleanReport report;
  const TriangleMesh cleaned = clean(mesh, &report);
  CHECK(report.duplicates == 4);
  CHECK(report.separated == 0);
  CHECK(report.kept == std::vector<Index>{0, 5});
  CHECK(cleaned.positions.size() == 4);
  // The same UVs in another texture are other texels.
  TriangleMesh two = make_plane(1, 1);
  add_face(two, two.faces[0], two.face_uvs[0]);
  two.materials = {{"a", "a.png"}, {"b", "b.png"}};
  two.face_materials = {0, 0, 1};
  clean(two, &report);
  CHECK(report.separated == 1);
  CHECK(report.duplicates == 0);
}

TEST_CASE("a decal leaves the wall, which stays in one piece", "[coincident_faces]") {
  for (const bool decal_first : {false, true}) {
    const TriangleMesh wall = make_plane(3, 3);
    TriangleMesh mesh = wall;
    const auto shift = Index(wall.uvs.size());
    for (const Vec2& uv : wall.uvs) mesh.uvs.push_back(uv / 3 + Vec2(2, 2));
    for (const Index f : {8U, 9U, 10U, 11U}) {  // two cells
      const auto& u = wall.face_uvs[f];
      add_face(mesh, wall.faces[f], {u[0] + shift, u[1] + shift, u[2] + shift});
    }
    if (decal_first) {
      std::rotate(mesh.faces.begin(), mesh.faces.end() - 4, mesh.faces.end());
      std::rotate(mesh.face_uvs.begin(), mesh.face_uvs.end() - 4, mesh.face_uvs.end());
    }
    CleanReport report;
    const TriangleMesh cleaned = clean(mesh, &report);
    CHECK(report.separated == 4);
    CHECK(report.manifold());
    const MeshReport r = report_mesh(cleaned);
    CHECK(r.components == 2);
    CHECK(r.boundary_edges == 12 + 6);
    std::vector<int> faces(2, 0);
    for (Index f = 0; f < cleaned.faces.size(); ++f) {
      ++faces[r.component_of_face[f]];
      const bool decal = cleaned.corner_uvs(f)[0].x() > 1.5;
      CHECK((r.component_of_face[f] == r.component_of_face[decal_first ? 0 : 18]) == decal);
    }
    CHECK(std::max(faces[0], faces[1]) == 18);
  }
}

TEST_CASE("a two-sided Moebius strip becomes its orientable double cover", "[coincident_faces]") {
  const TriangleMesh strip = make_moebius(2);
  CleanReport report;
  const TriangleMesh cleaned = clean(two_sided(strip), &report);
  CHECK(report.manifold());
  CHECK(cleaned.faces.size() == 2 * strip.faces.size());
  CHECK(cleaned.positions.size() == 2 * strip.positions.size());
  const MeshReport r = report_mesh(cleaned);
  CHECK(r.components == 1);
  CHECK(r.boundary_loops == 2);
  CHECK(r.orientable);
}

TEST_CASE("two layers with the same winding are told apart by their UVs", "[coincident_faces]") {
  TriangleMesh mesh = make_plane(3, 2);
  const TriangleMesh base = mesh;
  const auto shift = Index(base.uvs.size());
  for (const Vec2& uv : base.uvs) mesh.uvs.push_back(uv + Vec2(0, 4));
  for (std::size_t f = 0; f < base.faces.size(); ++f) {
    const auto& u = base.face_uvs[f];
    add_face(mesh, base.faces[f], {u[0] + shift, u[1] + shift, u[2] + shift});
  }
  shuffle_faces(mesh, 7);
  CleanReport report;
  const TriangleMesh cleaned = clean(mesh, &report);
  CHECK(report.manifold());
  const MeshReport r = report_mesh(cleaned);
  CHECK(r.components == 2);
  CHECK(r.charts == 2);
}

TEST_CASE("parts without any area are left out, flat faces with neighbours are not",
          "[coincident_faces]") {
  TriangleMesh mesh = make_plane(1, 1);
  const auto first = Index(mesh.positions.size());
  for (const double x : {5.0, 6.0, 8.0}) mesh.positions.emplace_back(x, x, x);
  add_face(mesh, {first, first + 1, first + 2}, {0, 1, 2});
  mesh.positions.emplace_back(0.5, 0, 0);
  add_face(mesh, {0, first + 3, 1}, {kNone, kNone, kNone});
  CleanReport report;
  const TriangleMesh cleaned = clean(mesh, &report);
  CHECK(report.flat == 1);
  CHECK(report.kept == std::vector<Index>{0, 1, 3});
  CHECK(cleaned.positions.size() == 5);
}

}  // namespace
}  // namespace onmesh
