#include "onmesh/mesh/closest_point.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "onmesh/base/error.h"

using namespace onmesh;

namespace {

Vec3 point(const std::array<Vec3, 3>& t, const Vec3& b) {
  return b[0] * t[0] + b[1] * t[1] + b[2] * t[2];
}

Vec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

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
    const double d = (point(mesh.corners(f), b) - p).norm();
    if (d < *distance - 1e-13) {  // a later face must be closer by more than rounding
      *distance = d;
      best = {f, b};
    }
  }
  return best;
}

}  // namespace

TEST_CASE("no point of a triangle is closer than the closest one", "[projection]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 300; ++i) {
    std::array<Vec3, 3> t;
    for (Vec3& corner : t) corner = random_vector(random);
    if (i % 3 == 1) t[2] = 0.5 * (t[0] + t[1]) + 1e-9 * random_vector(random);  // sliver
    if (i % 3 == 2) t[2] = t[1] + 1e-9 * random_vector(random);                 // needle
    const Vec3 p = 2 * random_vector(random);
    const Vec3 b = closest_barycentric(t, p);
    CHECK(b.minCoeff() >= 0);
    CHECK(b.sum() == Approx(1).epsilon(1e-15));
    const double d = (point(t, b) - p).norm();
    double least = 1e300;
    for (int j = 0; j < 2000; ++j) {
      double u = uniform(random), v = uniform(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (j % 4 != 3) v = 0;  // on an edge
      Vec3 q(1 - u - v, u, v);
      std::rotate(q.data(), q.data() + j % 3, q.data() + 3);
      least = std::min(least, (point(t, q) - p).norm());
    }
    CHECK(d <= least + 1e-14);
    CHECK(d >= least - 0.1);  // and the samples do come close to it
  }
}

TEST_CASE("the closest point above the inside of a triangle is the foot of the perpendicular",
          "[projection]") {
  const std::array<Vec3, 3> t{Vec3(1, 0, 0), Vec3(4, 1, 0), Vec3(2, 5, 0)};
  const Vec3 b(0.2, 0.3, 0.5);
  CHECK((closest_barycentric(t, point(t, b) + Vec3(0, 0, 3)) - b).norm() < 1e-15);
  CHECK((closest_barycentric(t, Vec3(0, -1, 2)) - Vec3::UnitX()).norm() == 0);
  const Vec3 edge = closest_barycentric(t, Vec3(3, 0, -1));  // beside the edge 0-1
  CHECK(edge[2] == 0);
}

TEST_CASE("the closest point of a degenerate triangle is that of its edges", "[projection]") {
  const Vec3 a(0, 0, 0), c(2, 0, 0);
  const std::array<Vec3, 3> flat{a, Vec3(1, 0, 0), c};
  CHECK((point(flat, closest_barycentric(flat, Vec3(1.5, 1, 0))) - Vec3(1.5, 0, 0)).norm() < 1e-15);
  const std::array<Vec3, 3> dot{c, c, c};
  CHECK((point(dot, closest_barycentric(dot, Vec3(1, 1, 1))) - c).norm() < 1e-15);
}

TEST_CASE("the tree finds the face that trying all faces finds", "[projection]") {
  const TriangleMesh mesh = bumpy_sheet(12);
  const ClosestPoint projection(mesh);
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p = 0.5 * (random_vector(random) + Vec3(1, 1, 0)) + 0.2 * random_vector(random);
    if (i % 4 == 0) p = mesh.positions[random() % mesh.positions.size()];  // on the surface
    double distance = 0;
    const SurfacePoint expected = brute_force(mesh, p, &distance);
    const SurfacePoint found = projection.closest(p);
    CHECK(found.face == expected.face);
    CHECK((found.barycentric - expected.barycentric).norm() < 1e-12);
  }
}

TEST_CASE("among equally close faces the lowest index is found, however the faces are ordered",
          "[projection]") {
  TriangleMesh mesh = bumpy_sheet(6);
  std::mt19937 random(11);
  for (int order = 0; order < 20; ++order) {
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), random);
    const ClosestPoint projection(mesh);
    for (Index v = 0; v < Index(mesh.positions.size()); ++v) {
      Index lowest = kNone;
      for (Index f = 0; f < Index(mesh.faces.size()); ++f)
        for (const Index w : mesh.faces[f])
          if (w == v) lowest = std::min(lowest, f);
      CHECK(projection.closest(mesh.positions[v]).face == lowest);
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
        CHECK(projection.closest((mesh.positions[v] * 2 + mesh.positions[w]) / 3).face == lowest);
      }
    }
  }
}

TEST_CASE("duplicate and mirror-symmetric faces tie to the lowest index", "[projection]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
  mesh.faces = {{3, 5, 4}, {0, 1, 2}, {0, 2, 1}, {3, 4, 5}};
  const ClosestPoint projection(mesh);
  CHECK(projection.closest({0.2, 0.3, 0}).face == 0);
  CHECK(projection.closest({0.2, 0.3, 0.5}).face == 1);
  CHECK(projection.closest({0.2, 0.3, 1}).face == 1);
  CHECK(projection.closest({-5, -5, 0}).face == 0);
}

TEST_CASE("faces without area are never found", "[projection]") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}};
  mesh.faces = {{0, 1, 2}, {3, 3, 4}, {3, 4, 5}};
  const ClosestPoint projection(mesh);
  CHECK(projection.closest({1, 0, 0}).face == 2);
  mesh.faces.pop_back();
  CHECK_THROWS_AS(ClosestPoint(mesh), InputError);
  CHECK_THROWS_AS(ClosestPoint(TriangleMesh()), InputError);
}

TEST_CASE("queries from several threads give what one thread gives", "[projection]") {
  const TriangleMesh mesh = bumpy_sheet(20);
  const ClosestPoint projection(mesh);
  std::vector<Vec3> points;
  std::mt19937 random(5);
  for (int i = 0; i < 4000; ++i) points.push_back(random_vector(random));
  std::vector<std::vector<SurfacePoint>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results)
    threads.emplace_back([&] {
      for (const Vec3& p : points) result.push_back(projection.closest(p));
    });
  for (auto& thread : threads) thread.join();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint alone = projection.closest(points[i]);
    for (const auto& result : results)
      if (result[i].face != alone.face || result[i].barycentric != alone.barycentric)
        FAIL("query " << i << " differs");
  }
  SUCCEED();
}
