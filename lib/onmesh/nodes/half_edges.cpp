#include "onmesh/nodes/half_edges.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
double HalfEdges::corner_angle(Index h) const {
  const double a = length[h], b = length[prev(h)], c = length[next(h)];
  // The dot product a b cos = (a^2 + b^2 - c^2) / 2, arranged against cancellation.
  const double dot = 0.5 * (b * b + (a - c) * (a + c));
  return std::atan2(2 * area(face(h)), dot);
}

double HalfEdges::area(Index f) const {
  return triangle_area(length[3 * f], length[3 * f + 1], length[3 * f + 2]);
}

double HalfEdges::circumradius(Index f) const {
  const double a = length[3 * f], b = length[3 * f + 1], c = length[3 * f + 2];
  return a * b * c / std::max(4 * area(f), 1e-300);
}

double HalfEdges::shortest_edge(Index f) const {
  return std::min({length[3 * f], length[3 * f + 1], length[3 * f + 2]});
}

std::array<Vec2, 3> HalfEdges::layout(Index f) const {
  const Vec2 a = Vec2::Zero(), b(length[3 * f], 0);
  return {a, b, opposite(3 * f, a, b)};
}

Vec2 HalfEdges::opposite(Index h, const Vec2& a, const Vec2& b) const {
  const double l = length[h], to_a = length[prev(h)], to_b = length[next(h)];
  const double along = 0.5 * ((to_a - to_b) * (to_a + to_b) / l + l);
  const double height = 2 * area(face(h)) / l;
  const Vec2 x = (b - a) / l;
  return a + along * x + height * Vec2(-x.y(), x.x());
}

double HalfEdges::cotan_sum(Index h) const {
  const auto cotan = [this](Index e) {
    const double a = length[e], b = length[next(e)], c = length[prev(e)];
    // Degenerate faces give a large finite value of the right sign.
    return ((b - a) * (b + a) + c * c) / (4 * std::max(area(face(e)), 1e-150 * (b * b + c * c)));
  };
  return cotan(h) + cotan(twin[h]);
}

bool HalfEdges::is_delaunay(Index h) const {
  // The tolerance keeps cocircular quadrilaterals from being flipped for ever.
  return twin[h] == kNone || cotan_sum(h) >= -1e-9;
}

bool HalfEdges::flip(Index h) {
  const Index t = twin[h];
  if (t == kNone || face(h) == face(t)) return false;
  // Faces (a, b, c) on the left of h and (b, a, d) on its right; counter-clockwise a, d, b, c.
  const std::array<Index, 4> old = around(h);  // bc, ca, ad, db
  const Index c = tail[old[1]], d = tail[old[3]];
  const Vec2 at_a(0, 0), at_b(length[h], 0);
  const Vec2 at_c = opposite(h, at_a, at_b), at_d = opposite(t, at_b, at_a);
  if (!(cross(at_d - at_a, at_c - at_a) > 0) || !(cross(at_c - at_b, at_d - at_b) > 0))
    return false;
  const double diagonal = (at_d - at_c).norm();
  if (!(diagonal > 0)) return false;

  struct Side {
    Index twin, tail;
    double length;
  };
  std::array<Side, 4> side;
  for (std::size_t i = 0; i < 4; ++i) side[i] = {twin[old[i]], tail[old[i]], length[old[i]]};
  // New faces: (d, c, a) in h's place with h = d->c, and (c, d, b) in t's place with t = c->d.
  for (std::size_t i = 0; i < 4; ++i) {
    const Index e = old[(i + 3) % 4];
    tail[e] = side[i].tail;
    length[e] = side[i].length;
    const auto inside = std::find(old.begin(), old.end(), side[i].twin);
    twin[e] = inside == old.end() ? side[i].twin : old[(inside - old.begin() + 3) % 4];
    // An outside twin learns the new number; twins among the four are set by their own turn.
    if (twin[e] != kNone) twin[twin[e]] = e;
  }
  tail[h] = d;
  tail[t] = c;
  length[h] = length[t] = diagonal;
  return true;
}

Index HalfEdges::flip_to_delaunay(std::vector<Index> suspects,
                                  const std::function<bool(Index)>& flip_edge) {
  Index flips = 0;
  // Lawson's algorithm ends after finitely many flips; in floating point a bound makes sure of it.
  const std::size_t bound = 1000 + 100 * tail.size();
  while (!suspects.empty() && flips < bound) {
    const Index h = suspects.back();
    suspects.pop_back();
    if (is_delaunay(h) || !flip_edge(h)) continue;
    ++flips;
    for (const Index e : around(h)) suspects.push_back(e);
  }
  return flips;
}

void mollify(HalfEdges& edges) {
  double sum = 0;
  for (const double l : edges.length) sum += l;
  const double slack =
      1e-12 * sum / static_cast<double>(std::max<std::size_t>(1, edges.length.size()));
  double add = 0;
  for (Index h = 0; h < edges.length.size(); ++h) {
    const double l = edges.length[h];
    const double others = edges.length[HalfEdges::next(h)] + edges.length[HalfEdges::prev(h)];
    add = std::max(add, slack - (others - l));
  }
  if (add > 0) {
    for (double& l : edges.length) l += add;
  }
}

Vec3 planar_barycentric(const std::array<Vec2, 3>& corners, const Vec2& p) {
  Vec3 b(cross(corners[1] - p, corners[2] - p), cross(corners[2] - p, corners[0] - p),
         cross(corners[0] - p, corners[1] - p));
  b = b.cwiseMax(0.0);
  const double sum = b.sum();
  return sum > 0 ? Vec3(b / sum) : Vec3::Constant(1.0 / 3);
}

}  // namespace onmesh
