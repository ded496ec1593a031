#include "onmesh/distance/exact.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "onmesh/base/error.h"
#include "onmesh/patches/grow_patch.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("exact distances from points on edges are not mirrored", "[exact]") {
  const TriangleMesh mesh = plane(6, 6, 1, 1, 0.2);
  ExactGeodesics exact(mesh);
  std::vector<SurfacePoint> targets;
  for (Index f = 0; f < mesh.faces.size(); f += 3) {
    targets.push_back({f, Vec3(0.1, 0.6, 0.3)});
    targets.push_back({f, Vec3(0.7, 0, 0.3)});
    targets.push_back({f, Vec3(0, 1, 0)});
  }
  const auto position = [&](const SurfacePoint& p) {
    const auto c = mesh.corners(p.face);
    return Vec3(p.barycentric[0] * c[0] + p.barycentric[1] * c[1] + p.barycentric[2] * c[2]);
  };
  for (const Index f : {0U, 17U, 40U, 71U})
    for (const Vec3& b : {Vec3(0.2, 0.8, 0), Vec3(0, 0.9, 0.1), Vec3(0.3, 0, 0.7), Vec3(1, 0, 0),
                          Vec3(0, 0, 1), Vec3(0.2, 0.3, 0.5)}) {
      const SurfacePoint source{f, b};
      const auto d = exact.distances(source, targets);
      for (std::size_t i = 0; i < targets.size(); ++i)
        REQUIRE(d[i] == Approx((position(source) - position(targets[i])).norm()).margin(1e-9));
    }
}

TEST_CASE("exact distances within a face are straight lines", "[exact]") {
  // Source, target and a corner of their face lie on one line, on which CGAL fails now and then.
  const TriangleMesh mesh = plane(3, 3, 1, 1);
  ExactGeodesics exact(mesh);
  std::vector<SurfacePoint> points;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; i + j <= 8; ++j) points.push_back({f, Vec3(i, j, 8 - i - j) / 8});
    }
  }
  double worst = 0;
  for (std::size_t s = 0; s < points.size(); s += 13) {
    const auto d = exact.distances(points[s], points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double straight = (mesh.position(points[i]) - mesh.position(points[s])).norm();
      worst = std::max(worst, std::abs(d[i] - straight));
      if (points[i].face == points[s].face) REQUIRE(d[i] == Approx(straight).margin(1e-15));
    }
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("the exact back end finds in its cut-out what the whole mesh has", "[exact]") {
  const TriangleMesh mesh = blob(3);
  const NodeMesh nodes = make_node_mesh(mesh);
  const double reach = 0.4;
  const Patch patch = grow_patch(nodes, {100, 101, 102, 103}, reach);
  const auto backend = make_exact(mesh, nodes);
  DistanceTable table, again;
  std::thread other([&] { backend->fill(patch, Reach::up_to(reach), again); });
  backend->fill(patch, Reach::up_to(reach), table);
  other.join();
  CHECK(table.squared == again.squared);
  ExactGeodesics exact(mesh);
  std::vector<SurfacePoint> targets;
  for (const Index v : patch.nodes) targets.push_back(nodes.nodes[v]);
  for (Index i = 0; i < table.rows; ++i) {
    const auto d = exact.distances(nodes.nodes[patch.nodes[i]], targets);
    for (Index j = 0; j < table.columns; ++j)
      if (d[j] <= reach) REQUIRE(std::sqrt(table.row(i)[j]) == Approx(d[j]).margin(1e-6));
  }
}

TEST_CASE("exact distances refuse a mesh that is not manifold", "[exact]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  mesh.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  CHECK_THROWS_AS(ExactGeodesics(mesh), InputError);
}

}  // namespace onmesh
