#include "onmesh/base/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/random_vector.h"

using namespace onmesh;

TEST_CASE("triangle area is right for needles and zero for impossible triangles", "[triangle]") {
  CHECK(triangle_area(3, 4, 5) == Approx(6));
  CHECK(triangle_area(5, 3, 4) == triangle_area(3, 4, 5));
  // Base 1e-9, height 1: the naive Heron formula loses all digits.
  CHECK(triangle_area(std::hypot(1, 0.5e-9), 1e-9, std::hypot(1, 0.5e-9)) ==
        Approx(0.5e-9).epsilon(1e-12));
  CHECK(triangle_area(1, 2, 3) == 0);
  CHECK(triangle_area(1, 1, 3) == 0);
  CHECK(triangle_area(0, 0, 0) == 0);
}

TEST_CASE("barycentric coordinates give back the point, inside and outside", "[triangle]") {
  const std::array<Vec2, 3> t{Vec2(1, 0), Vec2(4, 1), Vec2(2, 5)};
  for (const Vec3& b : {Vec3(0.2, 0.3, 0.5), Vec3(1, 0, 0), Vec3(-0.5, 0.25, 1.25)}) {
    CHECK((barycentric_in(t, interpolate(t, b)) - b).norm() < 1e-15);
  }
  const std::array<Vec2, 3> turned{t[0], t[2], t[1]};
  CHECK((barycentric_in(turned, t[2]) - Vec3::UnitY()).norm() < 1e-15);
  CHECK_FALSE(barycentric_in({t[0], t[0], t[1]}, t[2]).allFinite());
}

TEST_CASE("the distance from a segment is that from its line or its nearer end", "[triangle]") {
  double t = -1;
  CHECK(squared_distance_to_segment(Vec2(3, 2), Vec2(1, 0), Vec2(5, 0), &t) == 4);
  CHECK(t == 0.5);
  CHECK(squared_distance_to_segment(Vec2(9, 3), Vec2(1, 0), Vec2(5, 0), &t) == 25);
  CHECK(t == 1);
  CHECK(squared_distance_to_segment(Vec3(-2, 0, 4), Vec3(1, 0, 0), Vec3(5, 0, 0), &t) == 25);
  CHECK(t == 0);
  CHECK(squared_distance_to_segment(Vec3(0, 3, 4), Vec3(0, 0, 0), Vec3(0, 0, 0)) == 25);
}

TEST_CASE("no point of a triangle is closer than the closest one", "[triangle]") {
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
    const double d = (interpolate(t, b) - p).norm();
    double least = 1e300;
    for (int j = 0; j < 2000; ++j) {
      double u = uniform(random), v = uniform(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (j % 4 != 3) v = 0;  // on an edge
      Vec3 q(1 - u - v, u, v);
      std::rotate(q.data(), q.data() + j % 3, q.data() + 3);
      least = std::min(least, (interpolate(t, q) - p).norm());
    }
    CHECK(d <= least + 1e-14);
    CHECK(d >= least - 0.1);  // and the samples do come close to it
  }
}

TEST_CASE("the closest point above the inside of a triangle is the foot of the perpendicular",
          "[triangle]") {
  const std::array<Vec3, 3> t{Vec3(1, 0, 0), Vec3(4, 1, 0), Vec3(2, 5, 0)};
  const Vec3 b(0.2, 0.3, 0.5);
  CHECK((closest_barycentric(t, interpolate(t, b) + Vec3(0, 0, 3)) - b).norm() < 1e-15);
  CHECK((closest_barycentric(t, Vec3(0, -1, 2)) - Vec3::UnitX()).norm() == 0);
  const Vec3 edge = closest_barycentric(t, Vec3(3, 0, -1));  // beside the edge 0-1
  CHECK(edge[2] == 0);
}

TEST_CASE("the closest point of a degenerate triangle is that of its edges", "[triangle]") {
  const Vec3 a(0, 0, 0), c(2, 0, 0);
  const std::array<Vec3, 3> flat{a, Vec3(1, 0, 0), c};
  CHECK((interpolate(flat, closest_barycentric(flat, Vec3(1.5, 1, 0))) - Vec3(1.5, 0, 0)).norm() <
        1e-15);
  const std::array<Vec3, 3> dot{c, c, c};
  CHECK((interpolate(dot, closest_barycentric(dot, Vec3(1, 1, 1))) - c).norm() < 1e-15);
}
