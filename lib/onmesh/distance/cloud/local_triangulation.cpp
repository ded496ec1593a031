#include "onmesh/distance/cloud/local_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh::cloud {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTwoPi = 2 * kPi;
constexpr double kSameAngle = 1e-7;
// A neighbour whose way over the surface is longer than this times the straight one is beyond a
// fold.
constexpr double kLongestDetour = 1.3;
// The first ball's radius, and the largest, in distances of the farthest adjacent point.
constexpr double kFirstBall = 1.25, kLargestBall = 3;

// Of the angle between the sides x and y of a triangle, opposite z.
double cotangent(double x, double y, double z, double area) {
  return (x * x + y * y - z * z) / (4 * area);
}

}  // namespace

LocalTriangulation::LocalTriangulation(const PointCloud& points, const std::vector<Index>& order)
    : points_(points), order_(order), seen_(points.size(), kNone) {}

LocalTriangulation::Neighbour LocalTriangulation::see(const Neighbour& from, const Spoke& spoke,
                                                      bool& valid) const {
  Neighbour q;
  q.point = spoke.point;
  q.turn = from.turn * spoke.turn;
  const Sight sight = look(points_, from.point, q.point, spoke.turn);
  if (!(valid = sight.valid)) return q;
  // The sight lies in the plane of the point's own normal; signs do not matter for offsets.
  q.at = from.at + Vec2(from.u.dot(sight.offset), from.v.dot(sight.offset));
  // Turn from one normal to the other, the short way.
  const Vec3& n = points_.normal[from.point];
  const Vec3 m = spoke.turn * points_.normal[q.point];
  const Vec3 k = n.cross(m);
  q.u = from.u;
  q.v = from.v;
  if (k.squaredNorm() > 1e-20) {
    const double f = 1 / (1 + n.dot(m));
    const auto turned = [&](const Vec3& r) {
      const Vec3 kr = k.cross(r);
      return Vec3(r + kr + f * k.cross(kr));
    };
    q.u = turned(q.u);
    q.v = turned(q.v);
  }
  return q;
}

// The adjacent points. False if they are not in order around the centre.
bool LocalTriangulation::place_ring(Index centre) {
  const Vec3& n = points_.normal[centre];
  if (n.isZero()) return false;
  Neighbour self;
  self.point = centre;
  self.at.setZero();
  self.u = n.unitOrthogonal();
  self.v = n.cross(self.u);
  found_.clear();
  borders_.clear();
  seen_[centre] = centre;
  const Index begin = points_.offsets[centre], end = points_.offsets[centre + 1];
  double sum = 0;
  for (Index i = begin; i < end; ++i) {
    const Spoke& spoke = points_.spokes[i];
    if (seen_[spoke.point] == centre) return false;  // several edges to one point, or to itself
    seen_[spoke.point] = centre;
    bool valid = false;
    found_.push_back(see(self, spoke, valid));
    if (!valid) return false;
    found_.back().distance = found_.back().at.norm();
    if (i == begin) continue;
    const Vec2 &a = found_[found_.size() - 2].at, &b = found_.back().at;
    const double angle = std::atan2(cross(a, b), a.dot(b));
    if (angle < -kSameAngle) return false;
    sum += angle;
  }
  ring_ = found_.size();
  if (points_.is_closed[centre]) {
    const Vec2 &a = found_.back().at, &b = found_.front().at;
    const double angle = std::atan2(cross(a, b), a.dot(b));
    if (ring_ < 3 || angle < -kSameAngle) return false;
    sum += angle;
    return sum > kPi && sum < 1.5 * kTwoPi;  // once around
  }
  return ring_ >= 2 && sum > kSameAngle && sum < kTwoPi - kSameAngle;
}

// From the ring to everything within the radius that is joined to it within the radius.
void LocalTriangulation::walk(Index centre, double radius) {
  found_.resize(ring_);
  borders_.clear();
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const Neighbour from = found_[i];
    if (from.at.squaredNorm() > radius * radius || points_.normal[from.point].isZero()) continue;
    const Index begin = points_.offsets[from.point], end = points_.offsets[from.point + 1];
    const bool open = !points_.is_closed[from.point];
    for (Index s = begin; s < end; ++s) {
      const Spoke& spoke = points_.spokes[s];
      const bool border = open && (s == begin || s + 1 == end);
      if (!border && seen_[spoke.point] == centre) continue;
      bool valid = false;
      Neighbour q = see(from, spoke, valid);
      if (!valid) continue;
      if (border && spoke.point != centre) borders_.push_back({from.at, q.at});
      if (seen_[spoke.point] == centre || !(q.at.squaredNorm() <= radius * radius)) continue;
      seen_[spoke.point] = centre;
      found_.push_back(q);
    }
  }
}

bool LocalTriangulation::behind_border(const Neighbour& q) const {
  for (const auto& [a, b] : borders_) {
    const double eps = 1e-9 * (q.at.squaredNorm() + (b - a).squaredNorm());
    const double left = cross(q.at, a), right = cross(q.at, b);
    if (!((left > eps && right < -eps) || (left < -eps && right > eps))) continue;
    const double here = cross(b - a, -a), there = cross(b - a, q.at - a);
    if ((here > eps && there < -eps) || (here < -eps && there > eps)) return true;
  }
  return false;
}

// Everything acceptable by angle: from the first border edge if the fan is open, else from the
// closest, which always is a Delaunay neighbour.
void LocalTriangulation::sort_neighbours(Index centre) {
  const bool closed = points_.is_closed[centre];
  sorted_.clear();
  for (std::size_t i = 0; i < found_.size(); ++i) {
    Neighbour& q = found_[i];
    if (i >= ring_) {
      const Sight sight = look(points_, centre, q.point, q.turn);
      q.distance = sight.length;
      if (!sight.valid || q.at.norm() > kLongestDetour * sight.length || behind_border(q)) continue;
    }
    sorted_.push_back(q);
  }
  if (closed) {
    const auto nearest = std::min_element(
        sorted_.begin(), sorted_.end(), [&](const Neighbour& a, const Neighbour& b) {
          return std::pair(a.distance, order_[points_.node[a.point]]) <
                 std::pair(b.distance, order_[points_.node[b.point]]);
        });
    std::iter_swap(sorted_.begin(), nearest);
  }
  const Vec2 start = sorted_.front().at;
  const auto angle_from = [&](const Vec2& p) {
    const double angle = std::atan2(cross(start, p), start.dot(p));
    return angle < 0 ? angle + kTwoPi : angle;
  };
  for (Neighbour& q : sorted_) q.angle = angle_from(q.at);
  sorted_.front().angle = 0;
  if (!closed) {
    const double last = sorted_[ring_ - 1].angle;
    const Index last_point = sorted_[ring_ - 1].point;
    std::erase_if(sorted_, [&](const Neighbour& q) {
      return &q != &sorted_.front() && q.point != last_point &&
             (q.angle < kSameAngle || q.angle > last - kSameAngle);
    });
  }
  std::sort(sorted_.begin() + 1, sorted_.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.angle, a.point) < std::pair(b.angle, b.point);
  });
}

// Over the surface: in the plane, where a look is no way to tell.
double LocalTriangulation::distance(const Neighbour& a, const Neighbour& b) const {
  const Sight sight = look(points_, a.point, b.point, a.turn * b.turn);
  const double in_plane = (a.at - b.at).norm();
  return sight.valid && in_plane <= kLongestDetour * sight.length ? sight.length : in_plane;
}

// Whether the edge to b stays, of three neighbours in order.
bool LocalTriangulation::keep(Index centre, const Neighbour& a, const Neighbour& b,
                              const Neighbour& c) const {
  if (c.angle - a.angle >= kPi - kSameAngle) return true;  // a c does not pass between
  double ab = distance(a, b), bc = distance(b, c), ac = distance(a, c);
  double pa = a.distance, pb = b.distance, pc = c.distance;
  double at_a = triangle_area(pa, ab, pb), at_c = triangle_area(pc, bc, pb);
  double at_p = triangle_area(pa, ac, pc), at_b = triangle_area(ab, bc, ac);
  const double least = 1e-9 * (pa * pa + pb * pb + pc * pc);
  if (!(at_a > least && at_c > least && at_p > least && at_b > least)) {
    // Not the lengths of a quadrilateral: as it lies in the plane.
    pa = a.at.norm(), pb = b.at.norm(), pc = c.at.norm();
    ab = (a.at - b.at).norm(), bc = (b.at - c.at).norm(), ac = (a.at - c.at).norm();
    at_a = triangle_area(pa, ab, pb), at_c = triangle_area(pc, bc, pb);
    at_p = triangle_area(pa, ac, pc), at_b = triangle_area(ab, bc, ac);
    if (!(at_p > least && at_b > least)) return true;
    if (!(at_a > least && at_c > least)) return pb < pa || pb < pc;
  }
  const double difference = cotangent(pa, ab, pb, at_a) + cotangent(pc, bc, pb, at_c) -
                            cotangent(pa, pc, ac, at_p) - cotangent(ab, bc, ac, at_b);
  if (std::abs(difference) > 1e-6) return difference > 0;
  const auto rank = [&](Index point) { return order_[points_.node[point]]; };
  return std::min(rank(centre), rank(b.point)) < std::min(rank(a.point), rank(c.point));
}

// The Delaunay neighbours, by a scan in order of the angle: with the inversion at the centre, this
// is the scan for the convex hull.
void LocalTriangulation::select(Index centre) {
  star_.clear();
  const auto add = [&](const Neighbour& q) {
    while (star_.size() >= 2 && !keep(centre, star_[star_.size() - 2], star_.back(), q))
      star_.pop_back();
    star_.push_back(q);
  };
  for (const Neighbour& q : sorted_) {
    // Of two in one direction, the closer hides the other.
    if (!star_.empty() && q.angle - star_.back().angle < kSameAngle) {
      const bool last = &q == &sorted_.back() && !points_.is_closed[centre];
      if (!last && (star_.size() == 1 || q.distance >= star_.back().distance)) continue;
      star_.pop_back();
    }
    add(q);
  }
  if (points_.is_closed[centre]) {
    Neighbour again = sorted_.front();
    again.angle = kTwoPi;
    if (star_.size() > 1 && again.angle - star_.back().angle < kSameAngle) star_.pop_back();
    add(again);
  }
}

void LocalTriangulation::add_faces(Index centre, std::vector<LocalTriangle>& triangles) const {
  const Index begin = points_.offsets[centre], end = points_.offsets[centre + 1];
  for (Index i = begin; i < end; ++i) {
    if (points_.spokes[i].face == kNone) continue;
    const Spoke &a = points_.spokes[i], &b = points_.spokes[i + 1 < end ? i + 1 : begin];
    triangles.push_back({{centre, a.point, b.point}, {1, a.turn, b.turn}});
  }
}

void LocalTriangulation::triangulate(Index centre, std::vector<LocalTriangle>& triangles) {
  if (!place_ring(centre)) {
    add_faces(centre, triangles);
    return;
  }
  double farthest = 0;
  for (const Neighbour& q : found_) farthest = std::max(farthest, q.distance);
  // Nothing outside the circumcircles matters: grow the ball until it holds them.
  double radius = kFirstBall * farthest;
  for (int pass = 0;; ++pass) {
    walk(centre, radius);
    sort_neighbours(centre);
    select(centre);
    double needed = 0;
    for (std::size_t i = 0; i + 1 < star_.size(); ++i) {
      const Neighbour &a = star_[i], &b = star_[i + 1];
      const double ab = (a.at - b.at).norm(), area = 0.5 * std::abs(cross(a.at, b.at));
      needed = std::max(needed, a.at.norm() * b.at.norm() * ab / (2 * area));
    }
    needed = std::min(needed, kLargestBall * farthest);
    if (pass > 0 || !(needed > radius)) break;
    for (std::size_t i = ring_; i < found_.size(); ++i) seen_[found_[i].point] = kNone;
    radius = needed;
  }
  for (std::size_t i = 0; i + 1 < star_.size(); ++i) {
    const Neighbour &a = star_[i], &b = star_[i + 1];
    if (b.angle - a.angle >= kPi - kSameAngle || a.point == b.point) continue;
    triangles.push_back({{centre, a.point, b.point}, {1, a.turn, b.turn}});
  }
}

}  // namespace onmesh::cloud
