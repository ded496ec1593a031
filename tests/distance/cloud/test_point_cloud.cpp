#include "onmesh/distance/cloud/point_cloud.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "onmesh/procedural/shapes.h"
#include "support/distance_errors.h"

namespace onmesh {

TEST_CASE("several sheets at one node are several points", "[cloud]") {
  const TriangleMesh mesh = make_book(4, 40);
  const NodeMesh nodes = make_node_mesh(mesh);
  const cloud::PointCloud points =
      cloud::make_point_cloud(whole(nodes), cloud::make_node_geometry(mesh, nodes));
  std::map<Index, int> count;
  for (Index p = 0; p < points.size(); ++p) {
    ++count[points.node[p]];
    const Vec3& at = points.position[p];
    CHECK(points.normal[p].norm() == Approx(1));
    CHECK(points.is_flat[p]);
    // In the plane of its page.
    CHECK(std::abs(points.normal[p].y()) < 1e-12);
    CHECK(std::abs(points.normal[p].dot(at)) < 1e-12);
  }
  for (const auto& [node, several] : count)
    CHECK(several ==
          (std::hypot(mesh.positions[node].x(), mesh.positions[node].z()) < 1e-9 ? 3 : 1));
}

TEST_CASE("points on both sides of a crease see each other over it", "[cloud]") {
  cloud::PointCloud points;
  const double bend = 2.1;  // radians between the planes z = 0, x < 0 and the one that leaves x = 0
  const Vec3 down(std::cos(bend), 0, -std::sin(bend));
  points.position = {Vec3(-0.4, 0, 0), 0.7 * down + Vec3(0, 0.5, 0)};
  points.normal = {Vec3(0, 0, 1), Vec3(std::sin(bend), 0, std::cos(bend))};
  points.is_flat = {1, 1};
  const cloud::Sight there = look(points, 0, 1, 1), back = look(points, 1, 0, 1);
  REQUIRE(there.valid);
  CHECK(there.length == Approx(std::hypot(1.1, 0.5)));
  CHECK((there.offset - Vec3(1.1, 0.5, 0)).norm() < 1e-12);
  CHECK(back.length == Approx(there.length));
  points.normal[1] *= -1;
  CHECK(look(points, 0, 1, -1).length == Approx(there.length));
  points.is_flat[1] = 0;  // a rounded surface: straight
  points.normal[1] = Vec3(0, 0, 1);
  CHECK(look(points, 0, 1, 1).length == Approx((points.position[1] - points.position[0]).norm()));
}

}  // namespace onmesh
