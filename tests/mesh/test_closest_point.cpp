#include "onmesh/mesh/closest_point.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "onmesh/base/error.h"
#include "onmesh/base/triangle.h"
#include "support/random_vector.h"

using namespace onmesh;

namespace {

// z = bumps over [0, 1]^2, two faces per grid square.
TriangleMesh bumpy_sheet(int n) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.positions.emplace_back(double(i) / n, double(j) / n,
                                  0.1 * std::sin(9.0 * i / n) * std::cos(7.0 * j / n));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Index a = Index(j * (n + 1) + i), b = a + 1, c = a + Index(n) + 1, d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

SurfacePoint brute_force(const TriangleMesh& mesh, const Vec3& p, double* distance) {
  SurfacePoint best;
  *distance = 1e300;
  for (Index f = 0; f < Index(mesh.faces.size()); ++f) {
    const Vec3 b = closest_barycentric(mesh.corners(f), p);
    const double d = (interpolate(mesh.corners(f), b) - p).norm();
    if (d < *distance - 1e-13) {  // a later face must be closer by more than rounding
      *distance = d;
      best = {f, b};
    }
  }
  return best;
}

}  // namespace

TEST_CASE("the tree finds the face that trying all faces finds", "[closest_point]") {
  const TriangleMesh mesh = bumpy_sheet(12);
  const ClosestPoint tree(mesh);
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p = 0.5 * (random_vector(random) + Vec3(1, 1, 0)) + 0.2 * random_vector(random);
    if (i % 4 == 0) p = mesh.positions[random() % mesh.positions.size()];  // on the surface
    double distance = 0;
    const SurfacePoint expected = brute_force(mesh, p, &distance);
    const SurfacePoint found = tree.closest(p);
    CHECK(found.face == expected.face);
    CHECK((found.barycentric - expected.barycentric).norm() < 1e-12);
  }
}

TEST_CASE("among equally close faces the lowest index is found, however the faces are ordered",
          "[closest_point]") {
  TriangleMesh mesh = bumpy_sheet(6);
  std::mt19937 random(11);
  for (int order = 0; order < 20; ++order) {
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), random);
    const ClosestPoint tree(mesh);
    for (Index v = 0; v < Index(mesh.positions.size()); ++v) {
      Index lowest = kNone;
      for (Index f = 0; f < Index(mesh.faces.size()); ++f)
        for (const Index w : mesh.faces[f])
          if (w == v) lowest = std::min(lowest, f);
      CHECK(tree.closest(mesh.positions[v]).face == lowest);
    }
    for (Index f = 0; f < Index(mesh.faces.size()); ++f) {  // a third along each edge
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = mesh.faces[f][k], w = mesh.faces[f][(k + 1) % 3];
        Index lowest = f;
        for (Index g = 0; g < f; ++g) {
          const auto& c = mesh.faces[g];
          if (std::count(c.begin(), c.end(), v) && std::count(c.begin(), c.end(), w))
            lowest = std::min(lowest, g);
        }
        CHECK(tree.closest((mesh.positions[v] * 2 + mesh.positions[w]) / 3).face == lowest);
      }
    }
  }
}

TEST_CASE("duplicate and mirror-symmetric faces tie to the lowest index", "[closest_point]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
  mesh.faces = {{3, 5, 4}, {0, 1, 2}, {0, 2, 1}, {3, 4, 5}};
  const ClosestPoint tree(mesh);
  CHECK(tree.closest({0.2, 0.3, 0}).face == 0);
  CHECK(tree.closest({0.2, 0.3, 0.5}).face == 1);
  CHECK(tree.closest({0.2, 0.3, 1}).face == 1);
  CHECK(tree.closest({-5, -5, 0}).face == 0);
}

TEST_CASE("faces without area are never found", "[closest_point]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}};
  mesh.faces = {{0, 1, 2}, {3, 3, 4}, {3, 4, 5}};
  const ClosestPoint tree(mesh);
  CHECK(tree.closest({1, 0, 0}).face == 2);
  mesh.faces.pop_back();
  CHECK_THROWS_AS(ClosestPoint(mesh), InputError);
  CHECK_THROWS_AS(ClosestPoint(TriangleMesh()), InputError);
}

TEST_CASE("queries from several threads give what one thread gives", "[closest_point]") {
  const TriangleMesh mesh = bumpy_sheet(20);
  const ClosestPoint tree(mesh);
  std::vector<Vec3> points;
  std::mt19937 random(5);
  for (int i = 0; i < 4000; ++i) points.push_back(random_vector(random));
  std::vector<std::vector<SurfacePoint>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results)
    threads.emplace_back([&] {
      for (const Vec3& p : points) result.push_back(tree.closest(p));
    });
  for (auto& thread : threads) thread.join();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint alone = tree.closest(points[i]);
    for (const auto& result : results)
      if (result[i].face != alone.face || result[i].barycentric != alone.barycentric)
        FAIL("query " << i << " differs");
  }
  SUCCEED();
}
