#include "onmesh/cloud_complex.h"

#include <algorithm>
#include <numeric>

#include "onmesh/cloud_cover.h"
#include "onmesh/cloud_star.h"

namespace onmesh::cloud {
namespace {

// A triangle by its lowest point, counter-clockwise around that point's normal.
LocalTriangle from_lowest(const LocalTriangle& t) {
  const int k = int(std::min_element(t.point.begin(), t.point.end()) - t.point.begin());
  const int turn = t.turn[k];
  const int a = (k + (turn > 0 ? 1 : 2)) % 3, b = (k + (turn > 0 ? 2 : 1)) % 3;
  return {{t.point[k], t.point[a], t.point[b]}, {1, turn * t.turn[a], turn * t.turn[b]}};
}

// Which sides of which edges are taken: per point u the pairs of a point v > u and the side of u v.
class EdgeSides {
 public:
  EdgeSides(Index points, const std::vector<LocalTriangle>& triangles) : offsets_(points + 1, 0) {
    for (const LocalTriangle& t : triangles) {
      offsets_[t.point[0] + 1] += 2;
      ++offsets_[std::min(t.point[1], t.point[2]) + 1];
    }
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    taken_.resize(offsets_.back());
    end_.assign(offsets_.begin(), offsets_.end() - 1);
  }

  // Take the three sides that the triangle lies on, or none if one is taken already.
  bool take(const LocalTriangle& t) {
    const auto& [a, x, y] = t.point;
    const bool forward = x < y;
    const int turn = forward ? t.turn[1] : t.turn[2];
    const std::array<std::pair<Index, Index>, 3> sides{
        std::pair{a, 2 * x}, std::pair{a, 2 * y + 1},
        std::pair{std::min(x, y), 2 * std::max(x, y) + Index(forward == (turn < 0))}};
    for (const auto& [u, side] : sides)
      if (std::find(taken_.begin() + offsets_[u], taken_.begin() + end_[u], side) !=
          taken_.begin() + end_[u])
        return false;
    for (const auto& [u, side] : sides) taken_[end_[u]++] = side;
    return true;
  }

 private:
  std::vector<Index> offsets_, end_, taken_;
};

// All local triangles, most votes first; each once.
std::vector<LocalTriangle> vote(const Points& points, const std::vector<Index>& order) {
  std::vector<LocalTriangle> found;
  found.reserve(7 * points.size());
  Star star(points, order);
  for (Index p = 0; p < points.size(); ++p) star.triangulate(p, found);
  for (LocalTriangle& t : found) t = from_lowest(t);
  const auto less = [](const LocalTriangle& a, const LocalTriangle& b) {
    return a.point < b.point;
  };
  std::sort(found.begin(), found.end(), less);
  std::array<std::vector<LocalTriangle>, 3> by_votes;
  for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
    while (end < found.size() && found[end].point == found[begin].point) ++end;
    by_votes[3 - std::min<std::size_t>(3, end - begin)].push_back(found[begin]);
  }
  for (const int fewer : {1, 2})
    by_votes[0].insert(by_votes[0].end(), by_votes[fewer].begin(), by_votes[fewer].end());
  return std::move(by_votes[0]);
}

class Components {
 public:
  explicit Components(std::size_t nodes) : parent_(nodes) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }
  bool joined(const std::array<Index, 3>& corner) {
    return root(corner[0]) == root(corner[1]) && root(corner[0]) == root(corner[2]);
  }
  void join(const std::array<Index, 3>& corner) {
    for (int k = 1; k < 3; ++k) {
      const Index a = root(corner[0]), b = root(corner[k]);
      parent_[std::max(a, b)] = std::min(a, b);
    }
  }

 private:
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<Index> parent_;
};

}  // namespace

Complex make_complex(const Patch& patch, const NodeGeometry& geometry) {
  const Points points = make_points(patch, geometry);
  Complex complex;
  Patch& out = complex.triangles;
  out.nodes = patch.nodes;
  out.core_nodes = patch.core_nodes;
  Components components(patch.nodes.size());
  const auto add = [&](const std::array<Index, 3>& corner, const std::array<double, 3>& lengths) {
    if (!has_area(lengths)) return;
    out.corners.push_back(corner);
    out.lengths.push_back(lengths);
    components.join(corner);
  };

  const std::vector<LocalTriangle> triangles = vote(points, patch.nodes);
  EdgeSides sides(points.size(), triangles);
  for (const LocalTriangle& t : triangles) {
    if (!sides.take(t)) continue;
    const auto& [a, b, c] = t.point;
    const auto length = [&](Index p, Index q, int turn) {
      const Sight sight = look(points, std::min(p, q), std::max(p, q), turn);
      return sight.valid ? sight.length : (points.position[p] - points.position[q]).norm();
    };
    add({points.node[a], points.node[b], points.node[c]},
        {length(a, b, t.turn[1]), length(b, c, t.turn[1] * t.turn[2]), length(c, a, t.turn[2])});
  }
  for (Index f = 0; f < patch.corners.size(); ++f)
    if (!components.joined(patch.corners[f])) add(patch.corners[f], patch.lengths[f]);
  for (const auto& l : out.lengths)
    out.longest_edge = std::max({out.longest_edge, l[0], l[1], l[2]});
  complex.cover = out;
  complex.weights = make_delaunay(complex.cover);
  return complex;
}

}  // namespace onmesh::cloud
