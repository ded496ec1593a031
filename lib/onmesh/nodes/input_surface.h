// The input mesh under an intrinsic triangulation: faces laid out in the plane, directions at
// vertices, and straight walks.
#pragma once

#include <array>
#include <vector>

#include "onmesh/mesh/surface_point.h"
#include "onmesh/nodes/half_edges.h"

namespace onmesh {

/// A surface that straight walks (geodesics) lead over, as the signposts of Sharp, Soliman & Crane
/// (Navigating Intrinsic Triangulations, 2019) need it.
///
/// Every half-edge has a direction at its tail, an angle in radians that is not normalised: around
/// a vertex the directions run over [0, total angle), and that of outgoing() is 0.
class InputSurface {
 public:
  /// Edges are mollified: see mollify().
  /// \pre every vertex has one fan of faces at most; twins run in opposite directions
  InputSurface(HalfEdges edges, Index vertices);

  const HalfEdges& edges() const { return edges_; }
  Index vertex_count() const { return static_cast<Index>(outgoing_.size()); }
  /// The face's corners laid out in the plane by HalfEdges::layout().
  const std::array<Vec2, 3>& layout(Index face) const { return layout_[face]; }
  double direction(Index h) const { return direction_[h]; }
  /// Sum of the angles around the vertex: 2 pi where the surface is flat inside, pi on a straight
  /// boundary.
  double total_angle(Index vertex) const { return total_angle_[vertex]; }
  bool on_boundary(Index vertex) const { return boundary_[vertex] != 0; }
  /// An outgoing half-edge, the clockwise-most one on the boundary; kNone if no face has the
  /// vertex.
  Index outgoing(Index vertex) const { return outgoing_[vertex]; }

  /// Where a straight walk ends.
  struct Trace {
    SurfacePoint point;
    Vec2 heading;  ///< unit, on arrival, in layout() of point.face
  };
  /// Walk straight on from a vertex; the boundary ends the walk.
  /// \param direction at the vertex, see above
  /// \param distance in the edges' unit
  Trace trace(Index vertex, double direction, double distance) const;
  /// Walk straight on from a point of a face.
  /// \param heading unit, in layout() of the face
  Trace trace(const SurfacePoint& from, const Vec2& heading, double distance) const;

 private:
  struct Walker;
  Walker start(Index vertex, double direction) const;
  Index exit_of(const Walker& walker, double& distance) const;
  void enter(Index twin, Index leave, Walker& walker) const;
  Trace walk_on(Walker walker, double distance) const;

  HalfEdges edges_;
  std::vector<std::array<Vec2, 3>> layout_;  // per face
  std::vector<double> direction_;            // per half-edge
  std::vector<Index> outgoing_;              // per vertex
  std::vector<double> total_angle_;          // per vertex
  std::vector<std::uint8_t> boundary_;       // per vertex
};

}  // namespace onmesh
