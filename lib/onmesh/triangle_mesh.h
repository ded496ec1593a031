// A triangle mesh with a UV per face corner, as plain arrays.
#pragma once

#include <string>
#include <vector>

#include "onmesh/types.h"

namespace onmesh {

struct Material {
  std::string name;
  std::string texture;  ///< image path, resolved against the material file; empty if there is none
};

/// Positions and UVs are indexed apart: position indices give connectivity, UV indices stay per
/// corner, so that a seam is an edge whose two faces have different UV indices.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec2> uvs;                       ///< v points up, [0,1] is one tile
  std::vector<std::array<Index, 3>> faces;     ///< into positions
  std::vector<std::array<Index, 3>> face_uvs;  ///< into uvs, one per face; kNone = no UV there
  std::vector<Index> face_materials;           ///< into materials, one per face; kNone = none
  std::vector<Material> materials;

  /// All three corners of the face have a UV.
  bool has_uvs(Index face) const {
    const auto& c = face_uvs[face];
    return c[0] != kNone && c[1] != kNone && c[2] != kNone;
  }
  std::array<Vec3, 3> corners(Index face) const {
    const auto& f = faces[face];
    return {positions[f[0]], positions[f[1]], positions[f[2]]};
  }
  std::array<Vec2, 3> corner_uvs(Index face) const {
    const auto& c = face_uvs[face];
    return {uvs[c[0]], uvs[c[1]], uvs[c[2]]};
  }
  Vec3 position(const SurfacePoint& p) const;
  Vec2 uv(const SurfacePoint& p) const;
  double face_area(Index face) const;
  /// Length of the bounding box's diagonal over vertices that faces use.
  double diagonal() const;
  /// Mean length over the mesh's edges, each edge once.
  double mean_edge_length() const;
};

/// Merge vertices of bitwise equal position and UVs of equal value (-0 counts as 0), and drop
/// positions and UVs that no face uses. Faces keep their order, and so does what is left of the
/// positions and UVs: a welded mesh stays as it is.
TriangleMesh weld(const TriangleMesh& mesh);

struct CleanReport {
  Index collapsed = 0;   ///< faces with a repeated vertex, dropped
  Index duplicates = 0;  ///< faces on the same three vertices as an earlier one, dropped (also if
                         ///< wound the other way: two-sided cloth)
  Index fins = 0;        ///< faces dropped as fins: see clean()
  Index flipped = 0;     ///< faces whose winding was reversed
  std::vector<Index> kept;  ///< original face index of every face that is left
};

/// Make the mesh fit for a half-edge structure where that loses nothing: drop faces with repeated
/// vertices, exact duplicates and fins, then wind every component consistently (the winding of the
/// majority of its area wins). UVs move with their corners. Faces without area stay: they join
/// their neighbours. Positions and UVs that no face uses any more are dropped.
///
/// A fin is a single triangle with its own back side that hangs on a closed surface by one edge and
/// is shorter than 1 % of the mesh's diagonal: what is left of a pocket in a scan once its vertices
/// are welded. Both sides go, else the edge would have three faces.
/// \throw InputError if a component cannot be oriented (Moebius strip). Edges with three or more
///   faces are passed over here and refused by make_half_edge_mesh().
TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report = nullptr);

/// The faces for which keep[face] is set, with unused positions and UVs dropped.
TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep);

}  // namespace onmesh
