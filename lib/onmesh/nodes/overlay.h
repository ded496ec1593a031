// Where an input face meets the node faces: the common refinement, one input face at a time.
#pragma once

#include <vector>

#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// A node face that overlaps an input face. On the overlap, barycentric coordinates in the node
/// face are to_node * (barycentric coordinates in the input face), an isometry laid out in the
/// plane.
struct OverlayPiece {
  Index node_face = kNone;
  Eigen::Matrix3d to_node;
};

struct Overlay {
  std::vector<Index> face_offsets;  ///< input faces + 1
  std::vector<OverlayPiece> pieces;

  /// The piece that holds the point: the largest least coordinate wins, then the first.
  Index piece_at(const SurfacePoint& point) const;
  /// The point in the piece that holds it, clamped to the face.
  NodePoint locate(const SurfacePoint& point) const;
};

class IntrinsicTriangulation;

/// Lay out, in the plane of each input face, the intrinsic faces that overlap it: starting at a
/// corner by the signposts, then from face to face over every edge that runs through the input
/// face. Unfolding is an isometry there because the inside of an input face holds no cone. Linear
/// in the pieces.
Overlay make_overlay(const IntrinsicTriangulation& triangulation);

/// A node mesh made from an input mesh, with the way from one to the other.
struct NodeSurface {
  NodeMesh nodes;
  Overlay overlay;
};

}  // namespace onmesh
