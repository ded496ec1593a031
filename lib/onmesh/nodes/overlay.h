// Where an input face meets the node faces: the common refinement, one input face at a time.
#pragma once

#include <vector>

#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// A node face that overlaps an input face.
struct OverlayPiece {
  Index node_face = kNone;  ///< of the node mesh
  /// On the overlap, barycentric coordinates in the node face are to_node * (barycentric
  /// coordinates in the input face): an isometry, as both are laid out in one plane there.
  Eigen::Matrix3d to_node;
};

/// The node faces over each input face.
struct Overlay {
  std::vector<Index> face_offsets;   ///< input faces + 1: where each one's pieces begin
  std::vector<OverlayPiece> pieces;  ///< of all input faces, one after the other

  /// The piece that holds the point: the largest least coordinate wins, then the first.
  /// \return kNone if the face has no pieces, as a face without area
  Index piece_at(const SurfacePoint& point) const;
  /// The point in the piece that holds it, clamped to the face.
  /// Looks through all pieces of the face: for many points there is OverlayLookup.
  /// \return face kNone if there is no piece
  NodePoint locate(const SurfacePoint& point) const;
  /// The point in a piece of its face, clamped to the node face.
  NodePoint in_piece(Index piece, const SurfacePoint& point) const;
};

}  // namespace onmesh
