#include "onmesh/distance/heat/linear_systems.h"

#include <catch2/catch.hpp>

#include "support/areas.h"
#include "support/distance_errors.h"
#include "support/mesh_parts.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("split faces have the patch's area and the gradients of linear functions",
          "[linear_systems]") {
  const TriangleMesh mesh = plane(6, 5, 6, 5, 0.3);
  const Patch patch = whole(make_node_mesh(mesh));
  const heat::LinearSystems systems = heat::make_linear_systems(patch, {}, 2);
  REQUIRE(systems.faces.size() == 4 * patch.corners.size());
  const double unit = systems.scale * systems.scale;
  double area = 0;
  for (std::size_t f = 0; f < systems.faces.size(); ++f) {
    const heat::SplitFace& split = systems.faces[f];
    area += unit * double(split.area);
    // The function x of the plane, per unit of the system. All four splits of a face are laid out
    // alike, the last one turned by 180 degrees.
    const auto c = mesh.corners(Index(f / 4));
    const double sign = f % 4 == 3 ? -0.5 : 0.5;
    const double u1 = sign * (c[1].x() - c[0].x()) / systems.scale,
                 u2 = sign * (c[2].x() - c[0].x()) / systems.scale;
    const double gx = u1 * double(split.gx1) + u2 * double(split.gx2),
                 gy = u1 * double(split.gy1) + u2 * double(split.gy2);
    CHECK(gx * gx + gy * gy == Approx(1).epsilon(1e-5));
  }
  CHECK(area == Approx(area_of(mesh)).epsilon(1e-6));
}

TEST_CASE("a weight multiplies a face's area", "[linear_systems]") {
  const Patch patch = whole(make_node_mesh(plane(3, 3, 1, 1, 0.2)));
  std::vector<float> weights(patch.corners.size(), 1);
  weights[4] = 0.5F;
  const heat::LinearSystems one = heat::make_linear_systems(patch, {}, 1),
                            half = heat::make_linear_systems(patch, weights, 1);
  for (std::size_t f = 0; f < one.faces.size(); ++f)
    CHECK(half.faces[f].area == (f / 4 == 4 ? 0.5F : 1) * one.faces[f].area);
}

TEST_CASE("nodes know the first node of their component", "[linear_systems]") {
  const TriangleMesh sheet = plane(2, 2, 1, 1);
  const TriangleMesh mesh = side_by_side(sheet, sheet, {0, 0, 1});
  const auto half = Index(sheet.positions.size());
  const heat::LinearSystems systems = heat::make_linear_systems(whole(make_node_mesh(mesh)), {}, 1);
  for (Index i = 0; i < 2 * half; ++i) CHECK(systems.component[i] == (i < half ? 0 : half));
}

}  // namespace onmesh
