#include "onmesh/nodes/half_edges.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "support/small_meshes.h"

namespace onmesh {
namespace {

HalfEdges half_edges_of(const TriangleMesh& mesh) { return make_half_edges(mesh); }

}  // namespace

TEST_CASE("angles sum to pi, and layouts are true to length and area", "[half_edges]") {
  const HalfEdges e = half_edges_of(make_blob(2, 3));
  for (Index f = 0; f < e.face_count(); ++f) {
    CHECK(e.corner_angle(3 * f) + e.corner_angle(3 * f + 1) + e.corner_angle(3 * f + 2) ==
          Approx(std::numbers::pi).epsilon(1e-12));
    const auto at = e.layout(f);
    for (Index k = 0; k < 3; ++k)
      CHECK((at[(k + 1) % 3] - at[k]).norm() == Approx(e.length[3 * f + k]).epsilon(1e-12));
    const Vec2 a = at[1] - at[0], b = at[2] - at[0];
    CHECK((a.x() * b.y() - a.y() * b.x()) / 2 == Approx(e.area(f)).epsilon(1e-12));
    // The law of sines.
    CHECK(2 * e.circumradius(f) * std::sin(e.corner_angle(3 * f)) ==
          Approx(e.length[3 * f + 1]).epsilon(1e-12));
  }
}

TEST_CASE("cotangents tell acute from obtuse quadrilaterals", "[half_edges]") {
  // A rhombus of unit edges by its short diagonal and by its long one.
  for (const double half_angle : {0.4, 1.2}) {
    const double x = std::cos(half_angle), y = std::sin(half_angle);
    const HalfEdges e = half_edges_of(
        bare_mesh({{-x, 0, 0}, {x, 0, 0}, {0, y, 0}, {0, -y, 0}}, {{0, 1, 2}, {1, 0, 3}}));
    CHECK(e.cotan_sum(0) == Approx(2 / std::tan(std::numbers::pi - 2 * half_angle)).epsilon(1e-12));
    CHECK(e.is_delaunay(0) == (half_angle > std::numbers::pi / 4));
  }
}

TEST_CASE("flipping an edge makes it the other diagonal", "[half_edges]") {
  HalfEdges e = half_edges_of(
      bare_mesh({{0, 0, 0}, {2, 0, 0}, {1.2, 0.7, 0}, {0.9, -0.6, 0}}, {{0, 1, 2}, {1, 0, 3}}));
  const double area = e.area(0) + e.area(1);
  REQUIRE(e.flip(0));
  CHECK(e.length[0] == Approx(std::hypot(0.3, 1.3)).epsilon(1e-14));
  CHECK(e.length[e.twin[0]] == e.length[0]);
  CHECK(e.tail[0] == 3);
  CHECK(e.tip(0) == 2);
  CHECK(e.area(0) + e.area(1) == Approx(area).epsilon(1e-14));
  CHECK_FALSE(half_edges_of(make_plane(1, 1)).flip(0));  // on the boundary
}

TEST_CASE("a quadrilateral that is not convex does not flip", "[half_edges]") {
  HalfEdges e = half_edges_of(
      bare_mesh({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {3, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}));
  const std::vector<Index> tail = e.tail;
  CHECK_FALSE(e.flip(0));
  CHECK(e.tail == tail);
}

TEST_CASE("only meshes with a degenerate face are mollified, all edges by as much",
          "[half_edges]") {
  HalfEdges good = half_edges_of(make_cube(1));
  const std::vector<double> before = good.length;
  mollify(good);
  CHECK(good.length == before);
  HalfEdges flat = half_edges_of(
      bare_mesh({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}));
  const std::vector<double> lengths = flat.length;
  CHECK(flat.area(0) == 0);
  mollify(flat);
  CHECK(flat.area(0) > 0);
  for (std::size_t h = 0; h < lengths.size(); ++h) {
    CHECK(flat.length[h] - lengths[h] > 0);
    CHECK(flat.length[h] - lengths[h] < 1e-11);
  }
}

TEST_CASE("points of a triangle keep their barycentric coordinates, others are clamped",
          "[half_edges]") {
  const std::array<Vec2, 3> at{Vec2(0, 0), Vec2(3, 0), Vec2(1, 2)};
  const Vec3 b(0.2, 0.5, 0.3);
  CHECK((planar_barycentric(at, b[0] * at[0] + b[1] * at[1] + b[2] * at[2]) - b).norm() < 1e-15);
  const Vec3 outside = planar_barycentric(at, Vec2(1, -1));
  CHECK(outside.minCoeff() == 0);
  CHECK(outside.sum() == Approx(1));
}

}  // namespace onmesh
