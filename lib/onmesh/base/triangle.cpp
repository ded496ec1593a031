#include "onmesh/base/triangle.h"

#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/plane.h"

namespace onmesh {

double triangle_area(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  // The parentheses matter: with a >= b >= c each factor is accurate to rounding.
  const double slack = c - (a - b);
  if (!(slack > 0)) return 0;
  return 0.25 * std::sqrt((a + (b + c)) * slack * (c + (a - b)) * (a + (b - c)));
}

Vec3 barycentric_in(const std::array<Vec2, 3>& t, const Vec2& p) {
  return Vec3(twice_area(p, t[1], t[2]), twice_area(p, t[2], t[0]), twice_area(p, t[0], t[1])) /
         twice_area(t[0], t[1], t[2]);
}

Vec3 closest_barycentric(const std::array<Vec3, 3>& triangle, const Vec3& p) {
  // The foot of the perpendicular if it falls inside, else the best point of the three edges. All
  // are compared by their actual distance, which stays right for slivers, where "inside" is noise.
  Vec3 best = Vec3::UnitX();
  double best_distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& b) {
    const double d = (interpolate(triangle, b) - p).squaredNorm();
    if (d < best_distance) {
      best_distance = d;
      best = b;
    }
  };
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double squared = normal.squaredNorm();
  if (squared > 0) {
    Vec3 b;
    for (int k = 0; k < 3; ++k) {
      const Vec3& from = triangle[std::size_t(k + 1) % 3];
      b[k] = (triangle[std::size_t(k + 2) % 3] - from).cross(p - from).dot(normal) / squared;
    }
    if (b.minCoeff() >= 0) {
      b /= b.sum();
      offer(b);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const int j = (k + 1) % 3;
    const Vec3 edge = triangle[std::size_t(j)] - triangle[std::size_t(k)];
    const double length = edge.squaredNorm();
    const double t = length > 0 ? (p - triangle[std::size_t(k)]).dot(edge) / length : 0;
    Vec3 b = Vec3::Zero();
    b[j] = std::clamp(t, 0.0, 1.0);
    b[k] = 1 - b[j];
    offer(b);
  }
  return best;
}

}  // namespace onmesh
