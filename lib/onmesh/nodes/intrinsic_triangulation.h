// Intrinsic triangulations: edge lengths and signposts on half-edge connectivity, over an input
// mesh.
#pragma once

#include <span>
#include <vector>

#include "onmesh/nodes/half_edges.h"
#include "onmesh/nodes/input_surface.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// An intrinsic triangulation of an input mesh, with its flips, insertions and splits (Sharp,
/// Soliman & Crane, Navigating Intrinsic Triangulations, 2019).
///
/// Every half-edge has a signpost: its direction at its tail, as an angle in radians that is not
/// normalised, so at a vertex the directions run over [0, total angle). Direction 0 is
///   - at an input vertex: its first input half-edge (the clockwise-most one on the boundary);
///   - at an inserted node: the x axis of the layout of the input face that it lies in.
///
/// Input vertices stay nodes with their indices; inserted nodes get the following ones.
class IntrinsicTriangulation {
 public:
  /// Starts as the input itself, which is mollified: see mollify().
  /// \param input of a mesh (half_edge_mesh.h), or what no mesh of vertices can tell, as slits
  /// \param vertices number of them; some may have no face
  /// \pre every vertex has one fan of faces at most; twins run in opposite directions
  IntrinsicTriangulation(HalfEdges input, Index vertices);

  const InputSurface& input() const { return input_; }
  const HalfEdges& edges() const { return edges_; }
  Index node_count() const { return static_cast<Index>(outgoing_.size()); }
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
  /// \return false if the edge cannot flip
  bool flip(Index h);
  /// Flip until every edge is Delaunay.
  /// \return number of flips
  Index flip_to_delaunay();
  /// Flip until every edge is Delaunay where all were but for those of the faces around the node.
  /// All faces that change are around it afterwards.
  /// \return number of flips
  Index restore_delaunay(Index node);

  /// Insert a node inside a face. Barycentric coordinates near 0 make a face whose lengths
  /// determine its height badly: use split() there. The face keeps its number and two are appended.
  /// \return the node
  Index insert(Index face, const Vec3& barycentric);
  /// Insert a node on an edge. One face is appended on the boundary, else two.
  /// \param share of the way along h, in (0, 1)
  /// \return the node, or kNone if both sides of the edge are one face
  Index split(Index h, double share);

  /// Where a straight walk over the input surface ends that starts at a node in the given
  /// direction.
  InputSurface::Trace trace(Index node, double direction, double distance) const;
  /// Where a point of an intrinsic face lies on the input: traced from the face's closest corner.
  SurfacePoint on_input(const NodePoint& point) const;

  /// Faces, lengths and node locations as flat arrays.
  NodeMesh node_mesh() const;

 private:
  // The way from a face's closest corner to a point of the face, over the input.
  struct Walk {
    Index corner = 0;
    std::array<double, 3> distance{};  // from each corner
    InputSurface::Trace end;
  };
  Walk walk_to(Index face, const Vec3& barycentric) const;
  SurfacePoint place_on_boundary(Index edge, Index a, Index b, double share) const;
  void set_direction(Index h, double angle);
  // Signposts of a new node's edges, given counter-clockwise; a walk arrived along the first's
  // reverse.
  void turn_around(std::span<const Index> spokes, std::size_t first, const Vec2& arrival);
  Index append_faces(Index count);
  void append_node(Index outgoing, bool on_boundary, const SurfacePoint& location);
  void move_half_edge(Index from, Index to);
  void set_edge(Index h, Index twin, Index tail, Index tip, double length);
  bool is_input(Index node) const { return node < input_.vertex_count(); }

  InputSurface input_;
  HalfEdges edges_;
  std::vector<double> direction_;       // per half-edge
  std::vector<Index> outgoing_;         // per node
  std::vector<double> total_angle_;     // per node
  std::vector<std::uint8_t> boundary_;  // per node
  std::vector<SurfacePoint> locations_;
  std::vector<Index> suspects_;       // of restore_delaunay()
  std::vector<Index> boundary_edge_;  // per inserted node on the boundary: its input half-edge
};

}  // namespace onmesh
