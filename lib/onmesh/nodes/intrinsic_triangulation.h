// Intrinsic triangulations: edge lengths and signposts on half-edge connectivity, over an input
// mesh.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "onmesh/nodes/half_edge_mesh.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// A triangulated surface given by connectivity and edge lengths. Half-edge 3 f + k runs from
/// corner k of face f to corner k + 1; its face lies on its left. Several edges may join the same
/// two vertices, and an edge may join a vertex to itself, so edges are never looked up by their
/// ends.
struct HalfEdges {
  std::vector<Index> tail;     ///< per half-edge: the vertex it starts at
  std::vector<Index> twin;     ///< per half-edge: the other side; kNone on the boundary
  std::vector<double> length;  ///< per half-edge, equal on both sides

  static Index face(Index h) { return h / 3; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index face_count() const { return static_cast<Index>(tail.size() / 3); }
  Index tip(Index h) const { return tail[next(h)]; }
  /// The next outgoing half-edge counter-clockwise around the tail; kNone beyond the boundary.
  Index rotate(Index h) const { return twin[prev(h)]; }
  /// Interior angle at the tail of h, in its face.
  double corner_angle(Index h) const;
  double area(Index face) const;
  /// The face laid out in the plane: corner 0 at the origin, corner 1 on the positive x axis.
  std::array<Vec2, 3> layout(Index face) const;
  /// Where the vertex opposite h lies when h runs from `a` to `b`: on the left of it.
  Vec2 opposite(Index h, const Vec2& a, const Vec2& b) const;
  /// Sum of the cotangents of the angles opposite the edge: negative if it is not Delaunay.
  double cotan_sum(Index h) const;
  bool is_delaunay(Index h) const;

  /// Replace the edge by the other diagonal of its two faces, which keep their numbers. Half-edge h
  /// and its twin become the new diagonal's; the other four move: see around().
  /// \return false on the boundary, where both sides are one face, or where the two faces do not
  ///   form a strictly convex quadrilateral
  bool flip(Index h);
  /// The four half-edges around an edge and its twin in their cyclic order. A flip moves what is at
  /// each of them to the place of the one before.
  std::array<Index, 4> around(Index h) const {
    return {next(h), prev(h), next(twin[h]), prev(twin[h])};
  }
  /// Flip until every edge is Delaunay (Lawson's algorithm), starting with the given half-edges.
  /// \param flip_edge called to flip an edge with two sides; false if it cannot
  /// \return number of flips
  Index flip_to_delaunay(std::vector<Index> suspects, const std::function<bool(Index)>& flip_edge);
};

/// An intrinsic triangulation of an input mesh (Sharp, Soliman & Crane, Navigating Intrinsic
/// Triangulations, 2019). Every half-edge has a signpost: its direction at its tail, as an angle
/// that is not normalised, so at a vertex the directions run over [0, total angle). Direction 0 is
///   - at an input vertex: its first input half-edge (the clockwise-most one on the boundary);
///   - at an inserted node: the x axis of layout() of the input face that it lies in.
/// Input vertices stay nodes with their indices; inserted nodes get the following ones.
class IntrinsicTriangulation {
 public:
  /// Starts as the input mesh itself. Edge lengths are lengthened by one common amount, about 1e-12
  /// of their mean, if a face is degenerate otherwise (Sharp & Crane 2020, section 4.5).
  IntrinsicTriangulation(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges);
  /// The same for connectivity that no mesh of vertices can tell, as along slits.
  /// \pre every vertex has one fan of faces at most; twins run in opposite directions
  IntrinsicTriangulation(HalfEdges input, Index vertices);

  const HalfEdges& edges() const { return edges_; }
  const HalfEdges& input() const { return input_; }
  Index node_count() const { return static_cast<Index>(outgoing_.size()); }
  Index input_vertex_count() const { return input_vertices_; }
  const SurfacePoint& location(Index node) const { return locations_[node]; }
  double direction(Index h) const { return direction_[h]; }
  /// Sum of the angles around the node: 2 pi where the surface is flat inside, pi on a straight
  /// boundary.
  double total_angle(Index node) const { return total_angle_[node]; }
  bool on_boundary(Index node) const { return boundary_[node] != 0; }
  /// An outgoing half-edge; the clockwise-most one on the boundary.
  Index outgoing(Index node) const { return outgoing_[node]; }

  bool is_delaunay(Index h) const { return edges_.is_delaunay(h); }
  /// HalfEdges::flip() with signposts.
  bool flip(Index h);
  /// Flip until every edge is Delaunay. \return number of flips
  Index flip_to_delaunay();
  /// Flip until every edge is Delaunay where all were but for those of the faces around the node.
  /// All faces that change are around it afterwards. \return number of flips
  Index restore_delaunay(Index node);

  /// Insert a node inside a face. Barycentric coordinates near 0 make a face whose lengths
  /// determine its height badly: use split() there. The face keeps its number and two are appended.
  /// \return the node
  Index insert(Index face, const Vec3& barycentric);
  /// Insert a node on an edge, `share` (in (0, 1)) of the way along h. One face is appended on the
  /// boundary, else two. \return the node, or kNone if both sides of the edge are one face
  Index split(Index h, double share);

  struct Trace {
    SurfacePoint point;
    Vec2 direction;  ///< unit, on arrival, in layout() of point.face
  };
  /// Where a straight walk over the input surface ends that starts at a node in the given
  /// direction.
  Trace trace(Index node, double direction, double distance) const;
  /// Where a point of an intrinsic face lies on the input: traced from the face's closest corner.
  SurfacePoint on_input(const NodePoint& point) const;

  /// The input face's corners laid out by layout(face).
  const std::array<Vec2, 3>& input_layout(Index face) const { return input_layout_[face]; }
  /// Direction of an input half-edge at its tail (an input vertex).
  double input_direction(Index h) const { return input_direction_[h]; }
  double input_total_angle(Index vertex) const { return total_angle_[vertex]; }
  Index input_outgoing(Index vertex) const { return input_outgoing_[vertex]; }

  /// Faces, lengths and node locations as flat arrays.
  NodeMesh node_mesh() const;

 private:
  // The way from a face's closest corner to a point of the face, over the input.
  struct Walk {
    Index corner = 0;
    std::array<double, 3> distance{};  // from each corner
    Trace end;
  };
  Walk walk_to(Index face, const Vec3& barycentric) const;
  void set_direction(Index h, double angle);
  // Signposts of a new node's edges, given counter-clockwise; a walk arrived along the first's
  // reverse.
  void turn_around(std::span<const Index> spokes, std::size_t first, const Vec2& arrival);
  Index append_faces(Index count);
  void move_half_edge(Index from, Index to);
  void set_edge(Index h, Index twin, Index tail, Index tip, double length);

  Index input_vertices_ = 0;
  HalfEdges input_, edges_;
  std::vector<std::array<Vec2, 3>> input_layout_;
  std::vector<double> input_direction_;
  std::vector<Index> input_outgoing_;
  std::vector<double> direction_;       // per half-edge
  std::vector<Index> outgoing_;         // per node
  std::vector<double> total_angle_;     // per node
  std::vector<std::uint8_t> boundary_;  // per node
  std::vector<SurfacePoint> locations_;
  std::vector<Index> suspects_;       // of restore_delaunay()
  std::vector<Index> boundary_edge_;  // per inserted node on the boundary: its input half-edge
};

/// Barycentric coordinates of a point in a counter-clockwise planar triangle, clamped to it.
Vec3 planar_barycentric(const std::array<Vec2, 3>& corners, const Vec2& p);

}  // namespace onmesh
