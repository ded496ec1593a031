// Which boundary edges are the same edge but for rounding (internal).
#pragma once

#include <vector>

#include "onmesh/mesh/boundary.h"
#include "onmesh/mesh/scaled_points.h"

namespace onmesh {

/// Two edges, by their numbers among the boundary edges.
struct EdgeMatch {
  Index first = kNone, second = kNone;
  bool opposite = true;  ///< the second one's last end belongs to the first one's first end

  /// The pairs of vertices that belong together.
  std::array<std::array<Index, 2>, 2> ends(const std::vector<BoundaryEdge>& edges) const {
    const auto &a = edges[first].ends, &b = edges[second].ends;
    const std::size_t other = opposite ? 1 : 0;
    return {{{a[0], b[other]}, {a[1], b[1 - other]}}};
  }
};

struct EdgeMatches {
  std::vector<EdgeMatch> pairs;  ///< ascending by their first, lower, edges
  Index ambiguous = 0;           ///< edges with a partner that is not theirs alone
};

/// How far apart the ends of two edges may be that are one.
double tolerance_between(const BoundaryEdge& a, const BoundaryEdge& b, const ScaledPoints& scaled);

/// Pairs of edges that have each other as only partner, as join_boundaries() describes.
EdgeMatches match_edges(const TriangleMesh& mesh, const std::vector<BoundaryEdge>& edges,
                        const ScaledPoints& scaled);

}  // namespace onmesh
