#include "onmesh/mesh/match_edges.h"

#include <oneapi/tbb/parallel_for.h>

#include "onmesh/mesh/segment_tree.h"

namespace onmesh {
namespace {

/// An edge's partners: how many, up to two, and the first of them.
struct Partners {
  std::uint8_t count = 0;
  Index first = kNone;

  void add(Index edge) {
    if (count == 0) first = edge;
    if (count < 2) ++count;
  }
};

class EdgeMatcher {
 public:
  EdgeMatcher(const TriangleMesh& mesh, const std::vector<BoundaryEdge>& edges,
              const ScaledPoints& scaled)
      : mesh_(mesh), edges_(edges), scaled_(scaled), middles_(middles(), reaches()) {}

  /// The edge's only partner, and whether it runs the other way; kNone for none or several.
  EdgeMatch only_partner(Index edge, bool& ambiguous) const {
    const BoundaryEdge& e = edges_[edge];
    const double cap = kMostOfAnEdge * scaled_.length(e.ends);
    const Vec3 middle = middle_of(e);
    Partners opposite, alike;
    // Ends within the tolerance have middles within it.
    const double reach = scaled_.reach(cap);
    middles_.visit_near(middle, middle, reach, [&](Index other) {
      if (edges_[other].face == e.face) return reach;
      if (belongs(edge, other, true)) opposite.add(other);
      if (belongs(edge, other, false)) alike.add(other);
      return opposite.count > 1 ? -1 : reach;
    });
    const Partners& best = opposite.count > 0 ? opposite : alike;
    ambiguous = best.count > 1;
    return {edge, best.count == 1 ? best.first : kNone, opposite.count > 0};
  }

 private:
  Vec3 middle_of(const BoundaryEdge& edge) const {
    return (scaled_.points[edge.ends[0]] + scaled_.points[edge.ends[1]]) / 2;
  }
  std::vector<SegmentTree::Segment> middles() const {
    std::vector<SegmentTree::Segment> points;
    points.reserve(edges_.size());
    for (const BoundaryEdge& edge : edges_) points.push_back({middle_of(edge), middle_of(edge)});
    return points;
  }
  /// tolerance_between() is no more for any other edge.
  std::vector<double> reaches() const {
    std::vector<double> reaches;
    reaches.reserve(edges_.size());
    for (const BoundaryEdge& edge : edges_)
      reaches.push_back(kMostOfAnEdge * scaled_.length(edge.ends));
    return reaches;
  }

  bool belongs(Index edge, Index other, bool opposite) const {
    const BoundaryEdge &e = edges_[edge], &o = edges_[other];
    const double t = tolerance_between(e, o, scaled_);
    for (const auto& [a, b] : EdgeMatch{edge, other, opposite}.ends(edges_)) {
      if (!scaled_.within(a, b, t)) return false;
    }
    constexpr double kThickness = 2;  // tolerances: the sides are one apart, and rounded
    return !lie_on_each_other(scaled_.corners(mesh_.faces[e.face]),
                              scaled_.corners(mesh_.faces[o.face]), scaled_.points[e.ends[0]],
                              scaled_.points[e.ends[1]], kThickness * t);
  }

  const TriangleMesh& mesh_;
  const std::vector<BoundaryEdge>& edges_;
  const ScaledPoints& scaled_;
  const SegmentTree middles_;
};

}  // namespace

double tolerance_between(const BoundaryEdge& a, const BoundaryEdge& b, const ScaledPoints& scaled) {
  const double t = std::max(scaled.tolerance_along(a.ends), scaled.tolerance_along(b.ends));
  return std::min(t, kMostOfAnEdge * std::min(scaled.length(a.ends), scaled.length(b.ends)));
}

EdgeMatches match_edges(const TriangleMesh& mesh, const std::vector<BoundaryEdge>& edges,
                        const ScaledPoints& scaled) {
  const EdgeMatcher matcher(mesh, edges, scaled);
  std::vector<EdgeMatch> partner(edges.size());
  std::vector<std::uint8_t> ambiguous(edges.size(), 0);
  oneapi::tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t e) {
    bool several = false;
    partner[e] = matcher.only_partner(static_cast<Index>(e), several);
    ambiguous[e] = several;
  });
  EdgeMatches matches;
  for (Index e = 0; e < edges.size(); ++e) {
    const Index other = partner[e].second;
    if (other == kNone) {
      matches.ambiguous += ambiguous[e];
    } else if (partner[other].second != e) {
      ++matches.ambiguous;
    } else if (e < other) {
      matches.pairs.push_back(partner[e]);
    }
  }
  return matches;
}

}  // namespace onmesh
