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

/// Points in square cells, about one in each.
class PointCells {
 public:
  explicit PointCells(const std::vector<Vec2>& points) {
    low_ = high_ = points[0];
    for (const Vec2& p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    constexpr double kMostCellsAcross = 1024;
    across_ = Index(std::clamp(std::sqrt(double(points.size())), 1.0, kMostCellsAcross));
    cells_.resize(std::size_t(across_) * across_);
    for (Index i = 0; i < points.size(); ++i) {
      cells_[std::size_t(row(points[i].y())) * across_ + column(points[i].x())].push_back(i);
    }
  }

  /// Whether a point in the cells that meet a box satisfies `condition`.
  template <class Condition>
  bool any_in_box(const Vec2& low, const Vec2& high, const Condition& condition) const {
    for (Index y = row(low.y()); y <= row(high.y()); ++y) {
      for (Index x = column(low.x()); x <= column(high.x()); ++x) {
        const std::vector<Index>& cell = cells_[std::size_t(y) * across_ + x];
        if (std::any_of(cell.begin(), cell.end(), condition)) return true;
      }
    }
    return false;
  }

 private:
  Index cell(double value, double low, double high) const {
    const double share = high > low ? (value - low) / (high - low) : 0;
    return Index(std::clamp(share * across_, 0.0, double(across_ - 1)));
  }
  Index column(double x) const { return cell(x, low_.x(), high_.x()); }
  Index row(double y) const { return cell(y, low_.y(), high_.y()); }

  Vec2 low_, high_;
  Index across_ = 1;
  std::vector<std::vector<Index>> cells_;
};

/// Cuts ears off a polygon (Meisters 1975). Whether one is free is asked of the corners around it.
class EarClipping {
 public:
  explicit EarClipping(std::vector<Vec2> points) : points_(std::move(points)), cells_(points_) {
    left_ = points_.size();
    for (Index i = 0; i < left_; ++i) {
      next_.push_back((i + 1) % Index(left_));
      previous_.push_back((i + Index(left_) - 1) % Index(left_));
    }
    cut_off_.assign(left_, false);
    for (auto& blockers : blockers_) blockers.assign(left_, kNone);
  }

  Triangles run() {
    Triangles result;
    while (left_ > 3) {
      const Index ear = find_ear();
      if (ear == kNone) break;  // crosses itself: what is left is fanned
      result.push_back(triangle(ear));
      next_[previous_[ear]] = next_[ear];
      previous_[next_[ear]] = previous_[ear];
      for (auto& blockers : blockers_) blockers[previous_[ear]] = blockers[next_[ear]] = kNone;
      cut_off_[ear] = true;
      first_ = first_ == ear ? next_[ear] : first_;
      start_ = next_[ear];
      --left_;
    }
    std::vector<Index> ring(1, first_);
    for (Index i = next_[first_]; i != first_; i = next_[i]) ring.push_back(i);
    for (const auto& t : fan(ring)) result.push_back(t);
    return result;
  }

 private:
  std::array<Index, 3> triangle(Index i) const { return {previous_[i], i, next_[i]}; }

  /// No other corner lies in the ear; `closed` counts its edges in. Corners on the ear's own
  /// corners do not block: polygons with holes run along their bridges twice.
  bool is_free(const std::array<Index, 3>& t, bool closed) {
    Index& blocker = blockers_[closed ? 1 : 0][t[1]];
    // The same corner is still there: along a zigzag ribbon nearly all ears wait for others.
    if (blocker != kNone && !cut_off_[blocker]) return false;
    const Vec2 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const auto blocks = [&](Index i) {
      const Vec2& p = points_[i];
      if (cut_off_[i] || p == a || p == b || p == c) return false;
      const double least =
          std::min({twice_area(a, b, p), twice_area(b, c, p), twice_area(c, a, p)});
      if (!(closed ? least >= 0 : least > 0)) return false;
      blocker = i;
      return true;
    };
    return !cells_.any_in_box(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), blocks);
  }

  /// The best-shaped ear of a small polygon, the next good one of a large one (a search for the
  /// best would take cubic time); ears without area only when there is no other.
  Index find_ear() {
    constexpr std::size_t kSmall = 64;
    Index best = kNone;
    double best_shape = 0;
    for (const bool closed : {true, false}) {
      Index i = start_;
      for (std::size_t k = 0; k < left_; ++k, i = next_[i]) {
        const auto t = triangle(i);
        const double s = shape(points_[t[0]], points_[t[1]], points_[t[2]]);
        if (s <= best_shape || !is_free(t, closed)) continue;
        best = i;
        best_shape = s;
        if (left_ > kSmall && s > kSliver) return best;
      }
      if (best != kNone) return best;
    }
    Index i = first_;
    for (std::size_t k = 0; k < left_; ++k, i = next_[i]) {
      const auto t = triangle(i);
      if (twice_area(points_[t[0]], points_[t[1]], points_[t[2]]) == 0 && is_free(t, false)) {
        return i;
      }
    }
    return kNone;
  }

  const std::vector<Vec2> points_;
  const PointCells cells_;
  std::size_t left_ = 0;
  std::vector<Index> next_, previous_;  // of those left
  std::vector<bool> cut_off_;
  /// By whether edges count in, per ear the corner that it was found to hold; kNone = not known.
  std::array<std::vector<Index>, 2> blockers_;
  Index first_ = 0;  // the lowest that is left
  Index start_ = 0;  // where to look for the next ear
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
