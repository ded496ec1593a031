#include "onmesh/distance/distance_table.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/distance/unfold.h"
#include "onmesh/patches/grow_patch.h"
#include "support/distance_errors.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("nine node distances give the distance of two points of the plane", "[distance_table]") {
  const std::array<Vec3, 3> p{Vec3(0, 0, 0), Vec3(1, .1, 0), Vec3(.3, .9, 0)};
  const std::array<Vec3, 3> q{Vec3(3, 1, 0), Vec3(3.8, 2, 0), Vec3(2.9, 2.2, 0)};
  const auto lengths = [](const std::array<Vec3, 3>& t) {
    return std::array<double, 3>{(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()};
  };
  double squared[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) squared[i][j] = (p[i] - q[j]).squaredNorm();
  for (const Vec3& a : {Vec3(1, 0, 0), Vec3(.2, .3, .5), Vec3(.5, .5, 0)})
    for (const Vec3& b : {Vec3(0, 0, 1), Vec3(.1, .1, .8)}) {
      const Vec3 x = a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
      const Vec3 y = b[0] * q[0] + b[1] * q[1] + b[2] * q[2];
      const double va = barycentric_variance(lengths(p), a),
                   vb = barycentric_variance(lengths(q), b);
      CHECK(interpolate_squared(squared, a, b, va, vb) == Approx((x - y).squaredNorm()));
    }
  squared[0][2] = kUnreachable;
  CHECK(interpolate_squared(squared, Vec3(.5, .5, 0), Vec3(0, .5, .5), 0, 0) ==
        double(kUnreachable));
  CHECK(interpolate_squared(squared, Vec3(0, .5, .5), Vec3(0, 0, 1), 0, 0) < 100);
  const double zero[3][3] = {};
  CHECK(interpolate_squared(zero, Vec3(1, 0, 0), Vec3(1, 0, 0), 1, 1) == 0);
}

TEST_CASE("distances from a point inside a face follow from its corners' rows",
          "[distance_table]") {
  const TriangleMesh mesh = plane(10, 10, 1, 1, 0.3);
  const NodeMesh nodes = make_node_mesh(mesh);
  const Patch patch = grow_patch(nodes, {90, 91, 92}, 1.6);
  const DistanceTable table = fill(*make_unfold(), patch, 1.6);
  const Vec3 b(0.2, 0.5, 0.3);
  const auto c = mesh.corners(91);
  const Vec3 x = b[0] * c[0] + b[1] * c[1] + b[2] * c[2];
  const auto d = distances_from(patch, table, 1, b);
  REQUIRE(d.size() == patch.nodes.size());
  for (Index j = 0; j < d.size(); ++j)
    CHECK(d[j] == Approx((mesh.positions[patch.nodes[j]] - x).norm()).margin(1e-5));
}

}  // namespace onmesh
