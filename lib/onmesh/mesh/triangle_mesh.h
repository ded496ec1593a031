// A triangle mesh with a UV per face corner, as plain arrays.
#pragma once

#include <string>
#include <vector>

#include "onmesh/mesh/surface_point.h"

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
  /// A vertex twice, or no more area than rounding gives (1e-12 of the longest edge's square).
  bool is_degenerate(Index face) const;
  /// Signed area of the UV triangle, 0 if it is nothing but rounding. \pre has_uvs(face)
  double uv_area(Index face) const;
  /// Length of the bounding box's diagonal over vertices that faces use.
  double diagonal() const;
  /// Mean length over the mesh's edges, each edge once.
  double mean_edge_length() const;
};

/// Merge vertices of bitwise equal position and UVs of equal value (-0 counts as 0), and drop
/// positions and UVs that no face uses. Faces keep their order, and so does what is left of the
/// positions and UVs: a welded mesh stays as it is.
TriangleMesh weld(const TriangleMesh& mesh);

/// The opposite: every face gets positions and UVs of its own (a triangle soup).
TriangleMesh loosen(const TriangleMesh& mesh);

struct CleanReport {
  Index collapsed = 0;   ///< faces with a repeated vertex, dropped
  Index duplicates = 0;  ///< dropped: on the same three vertices as another face, either way round,
                         ///< with the same texels or none
  Index separated = 0;   ///< such faces with texels of their own: now sheets of their own
  Index fins = 0;        ///< faces dropped as fins: see clean()
  Index flat = 0;        ///< faces dropped because their whole component has no area
  Index flipped = 0;     ///< faces whose winding was reversed
  std::vector<Index> kept;  ///< original face index of every face that is left

  // What the result still is:
  Index branching_edges = 0;  ///< edges with three or more faces
  Index bow_ties = 0;         ///< vertices whose faces form more than one fan
  bool orientable = true;     ///< false: some component has only one side

  /// Fit for a half-edge structure.
  bool manifold() const { return branching_edges == 0 && bow_ties == 0 && orientable; }
  /// Why it is not manifold: "3 edges have more than two faces, ..."; empty if it is.
  std::string defects() const;
};

/// Make the mesh fit for filtering, and for a half-edge structure where that loses nothing: drop
/// faces with repeated vertices, fins and components without area, settle faces on the same three
/// vertices (below), then wind every component consistently (the winding of the majority of its
/// area wins; components that have only one side stay as they are). UVs move with their corners.
/// Faces without area that have neighbours with area stay: they join them. Positions and UVs that
/// no face uses any more are dropped.
///
/// Of faces on the same three vertices those with the same texels (UVs and texture) are one, and
/// those without texels (no UVs, or without area) go if another has some. What is left are layers,
/// like the two sides of cloth or a decal on a wall: separate_sheets() parts them.
///
/// A fin is a single triangle with its own back side that hangs on a closed surface by one edge and
/// is shorter than 1 % of the mesh's diagonal: what is left of a pocket in a scan once its vertices
/// are welded. Both sides go, else the edge would have three faces.
TriangleMesh clean(const TriangleMesh& mesh, CleanReport* report = nullptr);

/// The faces for which keep[face] is set, with unused positions and UVs dropped.
TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep);

}  // namespace onmesh
