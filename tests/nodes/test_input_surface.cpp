#include "onmesh/nodes/input_surface.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

InputSurface surface_of(const TriangleMesh& mesh) {
  return {make_half_edges(mesh), Index(mesh.positions.size())};
}

}  // namespace

TEST_CASE("a straight walk over folds ends where the unfolded one does", "[input_surface]") {
  const TriangleMesh folded = make_folded_sheet(7, 2, 1, 75);
  const TriangleMesh flat = make_plane(7, 1, 2, 1);
  const InputSurface surface = surface_of(folded);
  for (const double angle : {0.05, 0.2, 0.4}) {
    const auto walk = surface.trace(0, angle, 1.9);
    const Vec3 there = flat.position(walk.point);  // same faces, same barycentric coordinates
    const Vec3 start = flat.positions[0];
    CHECK((there - start).norm() == Approx(1.9).epsilon(1e-12));
  }
}

TEST_CASE("a walk back from where another one ended comes home", "[input_surface]") {
  const TriangleMesh mesh = make_blob(2, 5);
  const InputSurface surface = surface_of(mesh);
  double worst = 0;
  for (const Index v : {0U, 7U, 40U}) {
    for (double share = 0.05; share < 1; share += 0.1) {
      const auto there = surface.trace(v, share * surface.total_angle(v), 0.8);
      CHECK(there.heading.norm() == Approx(1).epsilon(1e-12));
      const auto back = surface.trace(there.point, -there.heading, 0.8);
      worst = std::max(worst, (mesh.position(back.point) - mesh.positions[v]).norm());
    }
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("directions of outgoing half-edges lead along them", "[input_surface]") {
  const TriangleMesh mesh = make_cube(2);
  const InputSurface surface = surface_of(mesh);
  const HalfEdges& e = surface.edges();
  for (Index h = 0; h < e.tail.size(); ++h) {
    const auto walk = surface.trace(e.tail[h], surface.direction(h), e.length[h]);
    CHECK((mesh.position(walk.point) - mesh.positions[e.tip(h)]).norm() < 1e-12);
  }
}

TEST_CASE("the boundary ends a walk", "[input_surface]") {
  const TriangleMesh mesh = make_plane(3, 3);
  const InputSurface surface = surface_of(mesh);
  REQUIRE(surface.on_boundary(0));
  const auto walk = surface.trace(0, surface.total_angle(0) / 3, 100);
  const Vec3 at = mesh.position(walk.point);
  CHECK(std::min({at.x(), at.y(), 1 - at.x(), 1 - at.y()}) == Approx(0).margin(1e-12));
  CHECK((at - mesh.positions[0]).norm() == Approx(1 / std::cos(std::numbers::pi / 6)));
}

}  // namespace onmesh
