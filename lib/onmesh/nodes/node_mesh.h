// The nodes that distances are computed between: a refined intrinsic triangulation as flat arrays.
#pragma once

#include <vector>

#include "onmesh/base/triangle.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A triangle complex given by its edge lengths. Two faces may share all their nodes, and a face
/// may have one node twice (multi-edges and self-edges of intrinsic triangulations): never look a
/// face or an edge up by its nodes. Non-manifold complexes are allowed.
struct NodeMesh {
  std::vector<SurfacePoint> nodes;          ///< where each node lies on the input mesh
  std::vector<std::array<Index, 3>> faces;  ///< into nodes
  /// lengths[f][k]: of face f's edge from corner k to corner (k + 1) % 3, mesh units.
  std::vector<std::array<double, 3>> lengths;
  /// Where each node's faces begin in node_faces (CSR): those of node n end before
  /// node_offsets[n + 1].
  std::vector<Index> node_offsets;
  std::vector<Index> node_faces;  ///< faces around each node, ascending, each once

  /// neighbours[f][k] = 3 g + l: edge k of face f is glued to edge l of face g, and to nothing
  /// else. kNone: boundary, or an edge with three or more faces. May be empty; then edges are told
  /// apart by their nodes and lengths, which fails only for different edges that have both in
  /// common. Bridges do not count.
  std::vector<std::array<Index, 3>> neighbours;

  /// So many of the last faces are bridges between components (bridge.h): paths cross them from the
  /// side opposite corner 0 to corner 0, or run along the edges there. They are no part of the
  /// surface, carry no texels and are in no overlay.
  Index bridge_faces = 0;

  /// Fill node_offsets and node_faces from faces.
  void build_incidence();
  /// 0 without faces.
  double longest_edge() const;
  /// From the face's lengths, square mesh units.
  double face_area(Index face) const;
};

/// A point in a node face: barycentric coordinates that sum to 1.
struct NodePoint {
  Index face = kNone;               ///< of the node mesh
  Vec3 barycentric = Vec3::Zero();  ///< weights of the face's corners
};

/// The mesh's own vertices and faces as nodes, unrefined. Node i is vertex i; its point's face is
/// kNone if no face uses the vertex. Faces glue where exactly two share a pair of vertices.
NodeMesh make_node_mesh(const TriangleMesh& mesh);

}  // namespace onmesh
