#include "onmesh/mesh_io/polygon_triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/base/plane.h"

namespace onmesh {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

/// Thinner than this (twice the area over the square of the longest edge) is a sliver to avoid.
constexpr double kSliver = 1e-6;

/// Twice the signed area over the square of the longest edge; 0 for a point.
double shape(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? twice_area(a, b, c) / longest : 0;
}

Triangles fan(const std::vector<Index>& ring) {
  Triangles result;
  for (std::size_t i = 2; i < ring.size(); ++i) result.push_back({ring[0], ring[i - 1], ring[i]});
  return result;
}

/// The polygon along the axis where Newell's normal is largest, running counterclockwise; empty if
/// it has no area. Dropping an axis is an affine map of the plane, so it keeps what is convex.
std::vector<Vec2> project(const std::vector<Vec3>& corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 p = corners[i] - corners[0];
    const Vec3 q = corners[(i + 1) % corners.size()] - corners[0];
    normal += p.cross(q);
  }
  int axis = 0;
  const double largest = normal.cwiseAbs().maxCoeff(&axis);
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double sign = normal[axis] > 0 ? 1 : -1;
  std::vector<Vec2> result;
  for (const Vec3& p : corners) {
    result.emplace_back(sign * (p[x] - corners[0][x]), p[y] - corners[0][y]);
  }
  return result;
}

/// Cuts ears off a polygon (Meisters 1975).
class EarClipping {
 public:
  explicit EarClipping(std::vector<Vec2> points) : points_(std::move(points)) {
    for (Index i = 0; i < points_.size(); ++i) ring_.push_back(i);
  }

  Triangles run() {
    Triangles result;
    while (ring_.size() > 3) {
      const std::size_t ear = find_ear();
      if (ear == ring_.size()) break;  // crosses itself: what is left is fanned
      result.push_back(triangle(ear));
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
      start_ = ear;
    }
    for (const auto& t : fan(ring_)) result.push_back(t);
    return result;
  }

 private:
  std::array<Index, 3> triangle(std::size_t i) const {
    const std::size_t n = ring_.size();
    return {ring_[(i + n - 1) % n], ring_[i], ring_[(i + 1) % n]};
  }

  /// No other corner lies in the ear; `closed` counts its edges in. Corners on the ear's own
  /// corners do not block: polygons with holes run along their bridges twice.
  bool is_free(const std::array<Index, 3>& t, bool closed) const {
    const Vec2 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    return std::none_of(ring_.begin(), ring_.end(), [&](Index i) {
      const Vec2& p = points_[i];
      if (p == a || p == b || p == c) return false;
      const double least =
          std::min({twice_area(a, b, p), twice_area(b, c, p), twice_area(c, a, p)});
      return closed ? least >= 0 : least > 0;
    });
  }

  /// The best-shaped ear of a small polygon, the next good one of a large one (a search for the
  /// best would take cubic time); ears without area only when there is no other.
  std::size_t find_ear() const {
    constexpr std::size_t kSmall = 64;
    const std::size_t n = ring_.size();
    std::size_t best = n;
    double best_shape = 0;
    for (const bool closed : {true, false}) {
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = (start_ + k) % n;
        const auto t = triangle(i);
        const double s = shape(points_[t[0]], points_[t[1]], points_[t[2]]);
        if (s <= best_shape || !is_free(t, closed)) continue;
        best = i;
        best_shape = s;
        if (n > kSmall && s > kSliver) return best;
      }
      if (best != n) return best;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto t = triangle(i);
      if (twice_area(points_[t[0]], points_[t[1]], points_[t[2]]) == 0 && is_free(t, false))
        return i;
    }
    return n;
  }

  std::vector<Vec2> points_;
  std::vector<Index> ring_;
  std::size_t start_ = 0;
};

}  // namespace

std::vector<std::array<Index, 3>> triangulate_polygon(const std::vector<Vec3>& corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  std::vector<Index> ring(corners.size());
  for (Index i = 0; i < ring.size(); ++i) ring[i] = i;
  Triangles result = fan(ring);
  std::vector<Vec2> points = project(corners);
  if (points.empty()) return result;
  const bool good = std::all_of(result.begin(), result.end(), [&](const auto& t) {
    return shape(points[t[0]], points[t[1]], points[t[2]]) > kSliver;
  });
  return good ? result : EarClipping(std::move(points)).run();
}

}  // namespace onmesh
