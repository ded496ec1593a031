// A triangle mesh with a UV per face corner, as plain arrays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/base/wrap.h"
#include "onmesh/mesh/coordinate_precision.h"
#include "onmesh/mesh/surface_point.h"

namespace onmesh {

/// What faces look like, by name.
struct Material {
  std::string name;     ///< as the file has it
  std::string texture;  ///< image path, resolved against the material file; empty if there is none
  /// How the texture is read beyond [0,1]; none = nobody says.
  std::optional<WrapModes> wrap = std::nullopt;
  /// What the texture's file holds if it is inside the mesh file; `texture` is only a name then.
  std::shared_ptr<const std::string> content = nullptr;
  bool is_opaque = false;  ///< said so: the texture's alpha means nothing
  /// Where the mesh file names the texture, for messages: "scene.glb: images[0].uri". Empty = the
  /// material's name is enough to find it.
  std::string place = {};
};

/// Positions and UVs are indexed apart: position indices give connectivity, UV indices stay per
/// corner, so that a seam is an edge whose two faces have different UV indices.
struct TriangleMesh {
  std::vector<Vec3> positions;                 ///< mesh units
  std::vector<Vec2> uvs;                       ///< v points up, [0,1] is one tile
  std::vector<std::array<Index, 3>> faces;     ///< into positions
  std::vector<std::array<Index, 3>> face_uvs;  ///< into uvs, one per face; kNone = no UV there
  std::vector<Index> face_materials;           ///< into materials, one per face; kNone = none
  std::vector<Material> materials;             ///< in the order of the file
  std::vector<Vec3> normals;                   ///< as the file has them, of any length
  /// Into normals, one per face; kNone = no normal there. Empty if there are none at all.
  std::vector<std::array<Index, 3>> face_normals;
  CoordinatePrecision precision;  ///< of the positions as they were stored
  bool is_flat = false;           ///< faces without normals are meant to look flat

  /// All three corners of the face have a UV.
  bool has_uvs(Index face) const {
    const auto& c = face_uvs[face];
    return c[0] != kNone && c[1] != kNone && c[2] != kNone;
  }
  /// How the face's texture is read beyond [0,1].
  /// \param otherwise where its material does not say
  WrapModes wrap_of(Index face, const WrapModes& otherwise) const {
    const Index material = face_materials.empty() ? kNone : face_materials[face];
    if (material == kNone) return otherwise;
    return materials[material].wrap.value_or(otherwise);
  }
  /// Positions of the face's corners.
  std::array<Vec3, 3> corners(Index face) const {
    const auto& f = faces[face];
    return {positions[f[0]], positions[f[1]], positions[f[2]]};
  }
  /// UVs of the face's corners.
  /// \pre has_uvs(face)
  std::array<Vec2, 3> corner_uvs(Index face) const {
    const auto& c = face_uvs[face];
    return {uvs[c[0]], uvs[c[1]], uvs[c[2]]};
  }
  /// The point in space.
  Vec3 position(const SurfacePoint& p) const;
  /// The point's UV.
  /// \pre has_uvs(p.face)
  Vec2 uv(const SurfacePoint& p) const;
  /// In squared mesh units.
  double face_area(Index face) const;
  /// A vertex twice, or no more area than rounding gives (1e-12 of the longest edge's square).
  bool is_degenerate(Index face) const;
  /// Signed area of the UV triangle (1 = a whole tile), 0 if it is nothing but rounding.
  /// \pre has_uvs(face)
  double uv_area(Index face) const;
  /// Length of the bounding box's diagonal over vertices that faces use; 0 without faces.
  double diagonal() const;
  /// Mean length over the mesh's edges, each edge once; 0 without edges.
  double mean_edge_length() const;
};

/// The triangle has a vertex twice.
inline bool has_repeated_vertex(const std::array<Index, 3>& face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// Merge vertices of bitwise equal position and UVs of equal value (-0 counts as 0), and drop
/// positions, UVs and normals that no face uses. Faces keep their order, and so does what is left
/// of the others: a welded mesh stays as it is.
TriangleMesh weld(const TriangleMesh& mesh);

/// The opposite: every face gets positions, UVs and normals of its own (a triangle soup).
TriangleMesh loosen(const TriangleMesh& mesh);

/// Vertices that faces of several materials use are split: each material gets one of its own, so
/// that the surface ends where materials do.
TriangleMesh separate_materials(const TriangleMesh& mesh);

/// The faces for which keep[face] is set, in their order; what only others use is dropped.
/// \pre keep has an entry per face
TriangleMesh extract_faces(const TriangleMesh& mesh, const std::vector<bool>& keep);

}  // namespace onmesh
