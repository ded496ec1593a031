// Boundaries that lie side by side without being joined.
#include "onmesh/mesh/near_boundaries.h"

#include <catch2/catch.hpp>

#include "onmesh/mesh/gap_search.h"
#include "onmesh/procedural/shapes.h"
#include "support/mesh_parts.h"
#include "support/rewritten_meshes.h"
#include "support/rounded_meshes.h"

namespace onmesh {
namespace {

NearBoundaries near(const TriangleMesh& mesh, double reach) {
  return find_near_boundaries(mesh, std::vector<double>(mesh.faces.size(), reach));
}

/// A square of n x n cells with a slit from the top to its middle.
TriangleMesh slit(int n, double width) {
  TriangleMesh mesh = rectangle(0, 0, 1, 1, n, n);
  const auto at = [&](int i, int j) { return Index(j * (n + 1) + i); };
  const auto first = Index(mesh.positions.size());
  for (int j = n / 2 + 1; j <= n; ++j) {
    mesh.positions.push_back(mesh.positions[at(n / 2, j)] + Vec3(width, 0, 0));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      double x = 0;
      for (const Vec2& uv : mesh.corner_uvs(Index(f))) x += uv.x() / 3;
      for (Index& v : mesh.faces[f]) {
        if (v == at(n / 2, j) && x > 0.5) v = first + Index(j - n / 2 - 1);
      }
    }
  }
  return mesh;
}

TEST_CASE("both sides of a gap within reach count, with its width", "[near_boundaries]") {
  const TriangleMesh mesh =
      side_by_side(rectangle(0, 0, 1, 1, 4, 4), rectangle(1, 0, 1, 1, 4, 4), {0.01, 0, 0});
  const NearBoundaries found = near(mesh, 0.02);
  CHECK(found.edges >= 8);
  CHECK(found.width == Approx(0.01));
  CHECK(found.weldable);
  CHECK(near(mesh, 0.005).edges == 0);
  CHECK(near(mesh, 0).edges == 0);
}

TEST_CASE("one boundary is not near itself, however fine", "[near_boundaries]") {
  for (const double reach : {0.01, 0.1, 0.2}) {
    CHECK(near(rectangle(0, 0, 1, 1, 50, 50), reach).edges == 0);
    CHECK(near(make_cylinder(60, 30), reach).edges == 0);
    CHECK(near(make_u_sheet(1, 1, 0.01, 8, 20), reach).edges == 0);
  }
}

TEST_CASE("a slit has two sides", "[near_boundaries]") {
  const NearBoundaries found = near(slit(16, 1e-3), 0.01);
  CHECK(found.edges >= 12);
  CHECK(found.edges <= 18);
  CHECK(found.weldable);
}

TEST_CASE("the sides of cloth are not near", "[near_boundaries]") {
  TriangleMesh back = rectangle(0, 0, 1, 1, 8, 8);
  reverse_winding(back);
  CHECK(near(side_by_side(rectangle(0, 0, 1, 1, 8, 8), back, {0, 0, 0.01}), 0.05).edges == 0);
}

TEST_CASE("across a slit is the point opposite", "[near_boundaries]") {
  const TriangleMesh mesh = slit(8, 0.01);
  const GapSearch search(mesh);
  int found = 0;
  for (Index e = 0; e < search.edges().size(); ++e) {
    const Vec3 from = search.position({e, 0.5});
    const auto there = search.across({e, 0.5}, 0.02);
    if (!there) continue;
    ++found;
    // The last edge on either side runs into the slit's end.
    const double wide = from.y() > 0.625 ? 0.01 : 0.005;
    CHECK((search.position(*there) - from).norm() == Approx(wide).epsilon(0.01));
    CHECK(mesh.position(search.surface_point(*there)).isApprox(search.position(*there)));
  }
  CHECK(found == 8);
}

}  // namespace
}  // namespace onmesh
