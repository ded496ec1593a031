#include "onmesh/distance/cloud/complex.h"

#include <algorithm>
#include <numeric>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/distance/cloud/local_triangulation.h"
#include "onmesh/distance/cloud/tufted_cover.h"

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
  // Beyond border edges nothing may lie: their outer sides are taken.
  EdgeSides(const PointCloud& points, const std::vector<LocalTriangle>& triangles)
      : offsets_(points.size() + 1, 0) {
    for (const LocalTriangle& t : triangles) {
      offsets_[t.point[0] + 1] += 2;
      ++offsets_[std::min(t.point[1], t.point[2]) + 1];
    }
    for (Index p = 0; p < points.size(); ++p) offsets_[p + 1] += points.is_closed[p] ? 0 : 2;
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    taken_.resize(offsets_.back());
    end_.assign(offsets_.begin(), offsets_.end() - 1);
    for (Index p = 0; p < points.size(); ++p) {
      if (points.is_closed[p]) continue;
      const Index first = points.spokes[points.offsets[p]].point;
      const Index last = points.spokes[points.offsets[p + 1] - 1].point;
      if (first > p) taken_[end_[p]++] = 2 * first + 1;
      if (last > p) taken_[end_[p]++] = 2 * last;
    }
  }

  // Take the three sides that the triangle lies on, unless one is taken already or less than
  // `least_known` of the edges have something on their other side.
  bool take(const LocalTriangle& t, int least_known) {
    const auto& [a, x, y] = t.point;
    const bool forward = x < y;
    const int turn = forward ? t.turn[1] : t.turn[2];
    const std::array<std::pair<Index, Index>, 3> sides{
        std::pair{a, 2 * x}, std::pair{a, 2 * y + 1},
        std::pair{std::min(x, y), 2 * std::max(x, y) + Index(forward == (turn < 0))}};
    int known = 0;
    for (const auto& [u, side] : sides) {
      if (is_taken(u, side)) return false;
      known += is_taken(u, side ^ 1);
    }
    if (known < least_known) return false;
    for (const auto& [u, side] : sides) taken_[end_[u]++] = side;
    return true;
  }

 private:
  bool is_taken(Index u, Index side) const {
    const auto end = taken_.begin() + end_[u];
    return std::find(taken_.begin() + offsets_[u], end, side) != end;
  }

  std::vector<Index> offsets_, end_, taken_;
};

// Appends the patch's faces, as triangles of the points at their corners.
void add_faces(const PointCloud& points, std::vector<LocalTriangle>& triangles) {
  for (Index p = 0; p < points.size(); ++p) {
    const Index begin = points.offsets[p], end = points.offsets[p + 1];
    for (Index i = begin; i < end; ++i) {
      if (points.spokes[i].face == kNone) continue;
      const Spoke &x = points.spokes[i], &y = points.spokes[i + 1 < end ? i + 1 : begin];
      if (p < x.point && p < y.point)
        triangles.push_back({{p, x.point, y.point}, {1, x.turn, y.turn}});
    }
  }
}

// The triangles of all local triangulations that fit together. In doubt things stay as they are:
// the patch's faces are candidates as well.
std::vector<LocalTriangle> choose(const PointCloud& points, const std::vector<Index>& order) {
  std::vector<LocalTriangle> found;
  found.reserve(8 * points.size());
  LocalTriangulation local(points, order);
  for (Index p = 0; p < points.size(); ++p) local.triangulate(p, found);
  const std::size_t first_face = found.size();
  add_faces(points, found);
  for (LocalTriangle& t : found) t = from_lowest(t);

  struct Candidate {
    LocalTriangle triangle;
    int votes;
  };
  constexpr int kCorner = 2, kFace = 1;  // votes of a corner that found it and of a face
  std::vector<Candidate> candidates;
  candidates.reserve(found.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    candidates.push_back({found[i], i < first_face ? kCorner : kFace});
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.triangle.point < b.triangle.point;
  });

  EdgeSides sides(points, found);
  std::vector<LocalTriangle> chosen;
  chosen.reserve(found.size() / 3);
  std::array<std::vector<LocalTriangle>, 3 * kCorner> doubtful;  // by votes
  for (std::size_t begin = 0, end = 0; begin < candidates.size(); begin = end) {
    const LocalTriangle& t = candidates[begin].triangle;
    int votes = 0;
    for (; end < candidates.size() && candidates[end].triangle.point == t.point; ++end)
      votes += candidates[end].votes;
    if (votes < 3 * kCorner)
      doubtful[std::size_t(votes)].push_back(t);
    else if (sides.take(t, 0))
      chosen.push_back(t);
  }
  // Fill the gaps: first from their corners, then from their sides.
  for (const int least_known : {2, 1}) {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t votes = doubtful.size(); votes-- > 1;)
        std::erase_if(doubtful[votes], [&](const LocalTriangle& t) {
          if (!sides.take(t, least_known)) return false;
          chosen.push_back(t);
          return changed = true;
        });
    }
  }
  return chosen;
}

}  // namespace

Complex make_complex(const Patch& patch, const NodeGeometry& geometry) {
  const PointCloud points = make_point_cloud(patch, geometry);
  Complex complex;
  Patch& out = complex.triangles;
  out.nodes = patch.nodes;
  out.core_nodes = patch.core_nodes;
  DisjointSets components(patch.nodes.size());
  const auto joined = [&](const std::array<Index, 3>& corner) {
    const Index root = components.find(corner[0]);
    return root == components.find(corner[1]) && root == components.find(corner[2]);
  };
  const auto add = [&](const std::array<Index, 3>& corner, const std::array<double, 3>& lengths) {
    if (!has_area(lengths)) return;
    out.corners.push_back(corner);
    out.lengths.push_back(lengths);
    components.join(corner[0], corner[1]);
    components.join(corner[0], corner[2]);
  };

  for (const LocalTriangle& t : choose(points, patch.nodes)) {
    const auto& [a, b, c] = t.point;
    add({points.node[a], points.node[b], points.node[c]},
        {edge_length(points, a, b, t.turn[1]), edge_length(points, b, c, t.turn[1] * t.turn[2]),
         edge_length(points, c, a, t.turn[2])});
  }
  for (Index f = 0; f < patch.corners.size(); ++f)
    if (!joined(patch.corners[f])) add(patch.corners[f], patch.lengths[f]);
  for (const auto& l : out.lengths)
    out.longest_edge = std::max({out.longest_edge, l[0], l[1], l[2]});
  complex.cover = out;
  complex.weights = flip_tufted_cover(complex.cover);
  return complex;
}

}  // namespace onmesh::cloud
