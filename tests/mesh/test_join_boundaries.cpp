// Boundaries that were meant to coincide.
#include "onmesh/mesh/join_boundaries.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "onmesh/base/triangle.h"
#include "onmesh/mesh/clean.h"
#include "onmesh/procedural/shapes.h"
#include "support/mesh_parts.h"
#include "support/rewritten_meshes.h"
#include "support/rounded_meshes.h"
#include "support/small_meshes.h"

namespace onmesh {
namespace {

constexpr double kStep = 0x1p-23;  // of floats in [1, 2)

TriangleMesh as_floats(TriangleMesh mesh) {
  mesh.precision.single = true;
  return mesh;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) sum += mesh.face_area(f);
  return sum;
}

double uv_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) sum += mesh.uv_area(f);
  return sum;
}

/// Two sheets side by side in the plane, the second one `gap` to the right of x = 1.
TriangleMesh two_sheets(double gap, int left_rows, int right_rows) {
  return side_by_side(rectangle(0, 0, 1, 1, 2, left_rows), rectangle(1, 0, 1, 1, 2, right_rows),
                      {gap, 0, 0});
}

TEST_CASE("loose triangles rounded each by itself become the surface they were", "[join]") {
  const TriangleMesh shapes[] = {make_sphere(3), make_torus(24, 12), make_blob(3, 5),
                                 make_gentle_sheet(9)};
  for (const TriangleMesh& shape : shapes) {
    const TriangleMesh whole = weld(shape);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      TriangleMesh soup = rounded_soup(whole, seed);
      shuffle_faces(soup, seed);
      JoinReport report;
      const TriangleMesh joined = join_boundaries(weld(soup), {}, &report);
      CHECK(joined.faces.size() == whole.faces.size());
      CHECK(joined.positions.size() == whole.positions.size());
      CHECK(count_boundary(joined) == count_boundary(whole));
      CHECK(report.t_junctions == 0);
      CHECK(report.refused_edges == 0);
      CHECK(clean(joined).faces.size() == whole.faces.size());
    }
  }
}

TEST_CASE("joining tells where vertices and faces went", "[join]") {
  const TriangleMesh soup = weld(rounded_soup(weld(make_sphere(2)), 7));
  JoinReport report;
  const TriangleMesh joined = join_boundaries(soup, {}, &report);
  REQUIRE(report.vertex.size() == soup.positions.size());
  REQUIRE(report.face.size() == joined.faces.size());
  for (Index v = 0; v < soup.positions.size(); ++v)
    CHECK((joined.positions[report.vertex[v]] - soup.positions[v]).norm() <= 2 * kStep);
  for (Index f = 0; f < joined.faces.size(); ++f) {
    CHECK(report.face[f] == f);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(joined.faces[f][k] == report.vertex[soup.faces[f][k]]);
    CHECK(joined.face_uvs[f] == soup.face_uvs[f]);
  }
}

TEST_CASE("a mesh without boundaries that coincide stays as it is", "[join]") {
  for (const TriangleMesh& shape :
       {make_plane(4, 3), make_chest(2), make_book(3), make_bow_tie(3), make_u_sheet(1, 1, 0.01)}) {
    const TriangleMesh mesh = as_floats(weld(shape));
    JoinReport report;
    const TriangleMesh joined = join_boundaries(mesh, {}, &report);
    CHECK(report.nothing_done());
    CHECK(joined.positions == mesh.positions);
    CHECK(joined.faces == mesh.faces);
    CHECK(joined.uvs == mesh.uvs);
    CHECK(joined.face_uvs == mesh.face_uvs);
  }
}

TEST_CASE("slits of four tolerances stay open, those of one close", "[join]") {
  const double t = 2 * (2 * kStep);  // coordinates end at 2 and beyond
  JoinReport report;
  join_boundaries(as_floats(two_sheets(4 * t, 4, 4)), {}, &report);
  CHECK(report.nothing_done());
  join_boundaries(as_floats(two_sheets(kStep, 4, 4)), {}, &report);
  CHECK(report.joined_edges == 4);
  join_boundaries(as_floats(two_sheets(4 * t, 4, 3)), {}, &report);
  CHECK(report.nothing_done());
  join_boundaries(as_floats(two_sheets(kStep, 4, 3)), {}, &report);
  CHECK(report.joined_edges == 6);
  CHECK(report.t_junctions == 5);
}

TEST_CASE("a tolerance given is kept to, up to an eighth of the edges", "[join]") {
  JoinReport report;
  join_boundaries(two_sheets(0.02, 4, 4), 0.01, &report);
  CHECK(report.nothing_done());
  join_boundaries(two_sheets(0.02, 4, 4), 0.03, &report);
  CHECK(report.joined_edges == 4);
  join_boundaries(two_sheets(0.04, 4, 4), 100, &report);
  CHECK(report.nothing_done());  // more than an eighth of 1 / 4
  join_boundaries(two_sheets(1e-9, 4, 4), 0, &report);
  CHECK(report.nothing_done());
}

TEST_CASE("no tolerance makes an edge collapse", "[join]") {
  for (const double tolerance : {1e-3, 0.05, 1.0, 1e9}) {
    for (const TriangleMesh& shape :
         {two_sheets(0.02, 4, 7), make_chest(3, 0.02), loosen(make_sphere(2)), make_cube(3),
          make_book(4), make_u_sheet(1, 1, 0.01), rounded_soup(make_blob(2, 3), 5)}) {
      const TriangleMesh mesh = weld(shape);
      JoinReport report;
      const TriangleMesh joined = join_boundaries(mesh, tolerance, &report);
      for (const auto& face : joined.faces) CHECK_FALSE(has_repeated_vertex(face));
      CHECK(shortest_edge(joined) > 0);
      CHECK(joined.faces.size() >= mesh.faces.size());
      for (const Vec3& p : joined.positions) CHECK(p.allFinite());
      for (const Vec2& uv : joined.uvs) CHECK(uv.allFinite());
    }
  }
}

TEST_CASE("T-junctions close with several vertices per edge and from both sides", "[join]") {
  for (const auto& [left, right] : {std::pair{1, 2}, {1, 7}, {3, 4}, {4, 6}, {12, 5}}) {
    TriangleMesh mesh = as_floats(two_sheets(0, left, right));
    round_to_floats(mesh, 3, [](Index) { return false; });
    move_rigidly(mesh, {0.3, -0.2, 0.1});
    round_to_floats(mesh, 4, [](Index) { return false; });
    JoinReport report;
    const TriangleMesh joined = join_boundaries(weld(mesh), {}, &report);
    CAPTURE(left, right);
    // The points on the common line, without its ends, that only one side has.
    const auto shared = Index(std::gcd(left, right));
    CHECK(report.t_junctions == Index(left + right) - 2 * shared);
    CHECK(report.joined_edges == Index(left + right) - shared);
    CHECK(count_boundary(joined) == Index(left + right) + 8);
    CHECK(area(joined) == Approx(2).epsilon(1e-6));
    CHECK(uv_area(joined) == Approx(uv_area(mesh)).epsilon(1e-6));
    CHECK(joined.faces.size() == mesh.faces.size() + report.t_junctions);
    for (Index f = 0; f < joined.faces.size(); ++f) {
      // Parts have the texels of the face that they come from.
      const Vec2 middle =
          (joined.corner_uvs(f)[0] + joined.corner_uvs(f)[1] + joined.corner_uvs(f)[2]) / 3;
      const Vec3 b = barycentric_in(mesh.corner_uvs(report.face[f]), middle);
      CHECK(b.minCoeff() > -1e-6);
    }
  }
}

TEST_CASE("faces are split at all of their edges", "[join]") {
  // A triangle with finer ones beyond each of its sides.
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 2}});
  const auto add_strip = [&](const Vec3& a, const Vec3& b, const Vec3& apex, int n) {
    for (int i = 0; i < n; ++i) {
      const auto v = static_cast<Index>(mesh.positions.size());
      mesh.positions.push_back(a + (b - a) * i / n);
      mesh.positions.push_back(apex);
      mesh.positions.push_back(a + (b - a) * (i + 1) / n);
      add_face(mesh, {v, v + 1, v + 2});
    }
  };
  add_strip({0, 0, 0}, {8, 0, 0}, {4, -8, 0}, 4);
  add_strip({8, 0, 0}, {0, 8, 0}, {8, 8, 0}, 8);
  add_strip({0, 8, 0}, {0, 0, 0}, {-8, 4, 0}, 2);
  const double before = area(mesh);
  JoinReport report;
  const TriangleMesh joined = join_boundaries(weld(mesh), {}, &report);
  CHECK(report.t_junctions == 3 + 7 + 1);
  CHECK(report.joined_edges == 4 + 8 + 2);
  CHECK(area(joined) == Approx(before));
  CHECK(count_boundary(joined) == 6);
  CHECK(std::count(report.face.begin(), report.face.end(), Index{0}) == 12);
}

TEST_CASE("a chart goes on over a T-junction whose UVs fit", "[join]") {
  const TriangleMesh joined = join_boundaries(weld(two_sheets(0, 3, 4)));
  CHECK(joined.uvs.size() == joined.positions.size());
}

TEST_CASE("the sides of cloth stay apart, however they are triangulated", "[join]") {
  const TriangleMesh front = rectangle(0, 0, 1, 1, 4, 4);
  for (int rows : {4, 5, 8}) {
    for (const double thickness : {kStep / 4, kStep, 0.01}) {
      TriangleMesh back = rectangle(0, 0, 1, 1, 4, rows);
      reverse_winding(back);
      const TriangleMesh cloth = as_floats(side_by_side(front, back, {0, 0, thickness}));
      JoinReport report;
      join_boundaries(weld(cloth), {}, &report);
      CAPTURE(rows, thickness);
      CHECK(report.nothing_done());
      join_boundaries(weld(cloth), 0.02, &report);
      CHECK(report.nothing_done());
    }
  }
}

TEST_CASE("loose triangles of cloth become its two sides", "[join]") {
  const TriangleMesh front = rectangle(0, 0, 1, 1, 4, 4);
  TriangleMesh back = front;
  reverse_winding(back);
  for (Vec2& uv : back.uvs) uv.x() += 2;
  const TriangleMesh soup = weld(rounded_soup(side_by_side(front, back, {0, 0, kStep}), 3));
  JoinReport report;
  const TriangleMesh joined = join_boundaries(soup, {}, &report);
  CHECK(joined.positions.size() == 2 * front.positions.size());
  CHECK(clean(joined).faces.size() == joined.faces.size());
}

TEST_CASE("edges with several partners are reported and left", "[join]") {
  // Three sheets that meet in one line, like the pages of a book.
  TriangleMesh book;
  for (int page = 0; page < 3; ++page) {
    TriangleMesh sheet = rectangle(0, 0, 1, 1, 2, 3);
    for (Vec3& p : sheet.positions) {
      const double angle = page * 2.0;
      p = {p.x() * std::cos(angle) + page * 1e-17, p.y(), p.x() * std::sin(angle)};
    }
    book = page == 0 ? sheet : side_by_side(book, sheet);
  }
  JoinReport report;
  join_boundaries(weld(book), {}, &report);
  CHECK(report.nothing_done());
  CHECK(report.refused_edges == 9);
}

TEST_CASE("chains of merges are reported and left", "[join]") {
  // Triangles around a point whose corners there form a chain: each edge has one partner, but the
  // ends of the chain are far apart.
  TriangleMesh fan;
  constexpr int n = 6;
  constexpr double t = 0.01;
  for (int i = 0; i < n; ++i) {
    const auto v = static_cast<Index>(fan.positions.size());
    const double a = 2 * i * std::numbers::pi / n, b = 2 * (i + 1) * std::numbers::pi / n;
    fan.positions.emplace_back(0.9 * t * i, 0, 0);
    fan.positions.emplace_back(std::cos(a), std::sin(a), 0);
    fan.positions.emplace_back(std::cos(b), std::sin(b), 0);
    add_face(fan, {v, v + 1, v + 2});
  }
  JoinReport report;
  const TriangleMesh joined = join_boundaries(weld(fan), t, &report);
  CHECK(report.nothing_done());
  CHECK(report.refused_edges == 10);
  CHECK(joined.positions == weld(fan).positions);
}

TEST_CASE("the size of the mesh does not matter", "[join]") {
  for (const double scale : {1e-280, 1e-30, 1e30, 1e280}) {
    TriangleMesh mesh = two_sheets(0, 3, 4);
    for (Vec3& p : mesh.positions) {
      p.x() += p.x() > 1 ? 1e-16 : 0;
      p *= scale;
    }
    JoinReport report;
    const TriangleMesh joined = join_boundaries(weld(mesh), {}, &report);
    CHECK(report.joined_edges == 6);
    CHECK(report.t_junctions == 5);
    for (const Vec2& uv : joined.uvs) CHECK(uv.allFinite());
  }
}

TEST_CASE("degenerate meshes are taken", "[join]") {
  CHECK(join_boundaries({}).faces.empty());
  const TriangleMesh line =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {1, 1, 2}});
  for (const double tolerance : {0.0, 1e-3, 10.0}) {
    const TriangleMesh joined = join_boundaries(line, tolerance);
    CHECK(joined.faces.size() >= 3);
    CHECK(shortest_edge(joined) > 0);
  }
}

}  // namespace
}  // namespace onmesh
