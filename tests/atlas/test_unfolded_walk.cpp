#include "onmesh/atlas/unfolded_walk.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/procedural/shapes.h"
#include "support/cut_meshes.h"
#include "support/mesh_parts.h"
#include "support/rewritten_meshes.h"
#include "support/small_meshes.h"

using namespace onmesh;

TEST_CASE("a walk over a flat sheet ends where the straight line does", "[unfolded_walk]") {
  const TriangleMesh mesh = make_plane(7, 5);
  const TexelMap map = make_texel_map(mesh, 50, 50);
  const UnfoldedWalk walk(mesh, map);
  const auto points = random_points(mesh, 200, 1);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LaidFace start = walk.lay_out(points[i - 1].face);
    // The first face's frame: its corners in the plane tell where any point of the sheet lies.
    const auto p = mesh.corners(points[i - 1].face);
    Eigen::Matrix2d sides, laid;
    sides << (p[1] - p[0]).head<2>(), (p[2] - p[0]).head<2>();
    laid << start.corners[1] - start.corners[0], start.corners[2] - start.corners[0];
    const Eigen::Matrix2d turn = laid * sides.inverse();
    const Vec2 to = start.corners[0] + turn * (mesh.position(points[i]) - p[0]).head<2>();
    const WalkEnd end = walk.over_surface(start, start.point(points[i - 1].barycentric), to);
    REQUIRE(end.arrived);
    const Vec3 at = mesh.position({end.laid.face, barycentric_in(end.laid.corners, to)});
    REQUIRE((at - mesh.position(points[i])).norm() < 1e-12);
  }
}

TEST_CASE("a walk over a fold goes as far as on the sheet laid out flat", "[unfolded_walk]") {
  // Along x, the sheet's length is that of its UVs.
  const TriangleMesh mesh = make_folded_sheet(6, 3, 1, 70);
  const UnfoldedWalk walk(mesh, make_texel_map(mesh, 60, 20));
  const LaidFace start = walk.lay_out(0);
  const Vec2 from = start.point(Vec3::Constant(1.0 / 3));
  const SurfacePoint first{0, Vec3::Constant(1.0 / 3)};
  for (const double u : {0.2, 0.45, 0.6, 0.93}) {
    const double length = 3 * (u - mesh.uv(first).x());
    // Corner 0 to 1 runs along x.
    const WalkEnd end = walk.over_surface(start, from, from + Vec2(length, 0));
    REQUIRE(end.arrived);
    const Vec2 uv = mesh.uv({end.laid.face, barycentric_in(end.laid.corners, end.point)});
    CHECK((uv - Vec2(u, mesh.uv(first).y())).norm() < 1e-12);
  }
}

TEST_CASE("a walk ends where the surface does, one within a chart at its seams",
          "[unfolded_walk]") {
  const TriangleMesh mesh = halves(2);
  const TexelMap map = make_texel_map(mesh, 60, 60);
  const UnfoldedWalk walk(mesh, map);
  const LaidFace start = walk.lay_out(0);  // from (0, 0) over x in [0, 1/2]
  const Vec2 from = start.point(Vec3::Constant(1.0 / 3));
  const Vec2 along = (start.corners[1] - start.corners[0]).normalized();
  const WalkEnd beyond = walk.over_surface(start, from, from + 10 * along);
  CHECK_FALSE(beyond.arrived);
  const Vec3 b = barycentric_in(beyond.laid.corners, beyond.point);
  const Vec3 at = mesh.position({beyond.laid.face, b});
  CHECK(at.x() == Approx(1));
  CHECK(at.y() == Approx(mesh.position({0, Vec3::Constant(1.0 / 3)}).y()));
  // The same in UVs: to a point of the own chart, and to one of the other half.
  const auto centre = [&](Index f) {
    const auto c = walk.pixel_corners(f);
    return Vec2((c[0] + c[1] + c[2]) / 3);
  };
  Index own = kNone, other = kNone;
  for (Index f = 1; f < mesh.faces.size(); ++f)
    (map.chart_of_face[f] == map.chart_of_face[0] ? own : other) = f;
  const auto reached = walk.within_chart(start, centre(0), centre(own));
  REQUIRE(reached.has_value());
  CHECK(reached->face == own);
  CHECK_FALSE(walk.within_chart(start, centre(0), centre(other)).has_value());
}

TEST_CASE("where several faces meet the walk takes the one that goes on most straight",
          "[unfolded_walk]") {
  // Three faces around the edge from 0 to 1: one at x < 0, one straight on, one upright.
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0.1}},
                                {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}});
  const UnfoldedWalk walk(mesh, make_texel_map(mesh, 4, 4));
  CHECK(walk.across(0, 0) == 3 * 2 + 0);
  CHECK(walk.across(2, 0) == 0);
  CHECK(walk.across(1, 0) == 0);  // folded by 90 degrees rather than 96
  CHECK(walk.across(0, 1) == kNone);
}

TEST_CASE("from a corner the way over an edge leads around that side", "[unfolded_walk]") {
  // Four faces of 60 degrees each around a tip. Straight away from face 0 lies 180 degrees from its
  // middle: the last of the three other faces, on either way around.
  TriangleMesh mesh = bare_mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
  for (const bool reversed : {false, true}) {
    if (reversed) reverse_winding(mesh);
    const UnfoldedWalk walk(mesh, make_texel_map(mesh, 4, 4));
    const LaidFace start = walk.lay_out(0);
    const Vec2 tip = start.corners[0];
    const Vec2 away = tip - (start.corners[1] + start.corners[2]) / 2;
    for (const int k : {0, 2}) {
      // Over the edge to vertex 1 lies face 3, over that to vertex 2 face 1.
      const bool to_vertex_1 = (k == 0) != reversed;
      const Vec2 side = start.corners[k == 0 ? 1 : 2] - start.corners[k == 0 ? 2 : 1];
      const WalkEnd beside = walk.over_edge(start, k, tip, tip - 0.1 * away + 0.3 * side);
      CHECK(beside.arrived);
      CHECK(beside.laid.face == (to_vertex_1 ? 3 : 1));
      const WalkEnd opposite = walk.over_edge(start, k, tip, tip + 0.2 * away);
      CHECK(opposite.arrived);
      CHECK(opposite.laid.face == (to_vertex_1 ? 1 : 3));
    }
  }
}
