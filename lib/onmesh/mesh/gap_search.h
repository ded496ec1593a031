// What lies across a gap beside a boundary (internal).
#pragma once

#include <optional>
#include <vector>

#include "onmesh/mesh/boundary.h"
#include "onmesh/mesh/segment_tree.h"

namespace onmesh {

/// A place on a boundary edge.
struct BoundaryPoint {
  Index edge = kNone;   ///< among the boundary edges
  double position = 0;  ///< 0 = its first end, 1 = its last one
};

/// Finds the other side of gaps between boundaries. Across a gap is the nearest that is on another
/// boundary, or more than four times as far along this one as straight. Nothing is, if the face
/// there lies on the one here, like the other side of cloth: see lie_on_each_other(). Queries are
/// const and may run in parallel.
class GapSearch {
 public:
  /// \pre mesh outlives this
  explicit GapSearch(const TriangleMesh& mesh);

  const std::vector<BoundaryEdge>& edges() const { return edges_; }
  /// The boundary edge that is side k of the face, from its corner k on; kNone if that is none.
  Index edge_of(Index face, Index k) const { return edge_of_side_[3 * std::size_t{face} + k]; }
  /// The boundary edges at a vertex.
  std::span<const Index> at_vertex(Index vertex) const { return at_vertex_.at(vertex); }
  Vec3 position(const BoundaryPoint& p) const;
  /// The same place on its face.
  SurfacePoint surface_point(const BoundaryPoint& p) const;

  /// The distance of the vertex that is across a gap from the edge, if it is at most `width`;
  /// negative if there is none.
  double gap_at(Index edge, double width) const;
  /// The closest point across a gap that is no wider than `width`; of equally close ones that on
  /// the first edge.
  std::optional<BoundaryPoint> across(const BoundaryPoint& from, double width) const;

 private:
  void follow(Index first);
  double along(const BoundaryPoint& p) const;
  bool is_across(const BoundaryPoint& from, const BoundaryPoint& to, double distance) const;
  bool is_other_side(Index edge, Index other, double distance) const;

  const TriangleMesh& mesh_;
  const std::vector<BoundaryEdge> edges_;
  const EdgesAtVertices at_vertex_;
  const SegmentTree tree_;           // of the edges
  std::vector<Index> edge_of_side_;  // side k of face f at 3 f + k

  /// Where an edge lies along its boundary.
  struct Place {
    Index line = kNone;  // number of the boundary
    double start = 0;    // length from the boundary's start to the edge's first end
    double sense = 1;    // -1 if the boundary is followed against the edge's direction
  };
  std::vector<Place> places_;
  std::vector<double> lengths_, totals_;  // of edges, of boundaries
};

}  // namespace onmesh
