// Which texel lies where on the surface: rasterisation of the UV triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/base/large_array.h"
#include "onmesh/image/lookup.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What charts have of a texel.
enum class Coverage : std::uint8_t {
  none,     ///< no chart meets the texel's square
  touched,  ///< a chart meets the square but not the centre: padding colour, filled as gutter
  covered,  ///< claimed: sample and target
};

/// A texel claimed by a face: unwrapped column and row (row 0 on top, may be negative or beyond the
/// image where UVs leave [0,1]).
struct TexelClaim {
  std::int32_t x = 0;  ///< column
  std::int32_t y = 0;  ///< row
};

/// A texture of the surface, as the atlas sees it. Its texels have numbers of their own among those
/// of all tiles: row by row from `first` on.
struct TexelTile {
  int width = 0;    ///< texels
  int height = 0;   ///< texels
  WrapModes wrap;   ///< how UVs outside [0,1] are read
  Index first = 0;  ///< number of the first texel; make_texel_map() sets it

  /// Number of the texel that is seen at a claim's place: wrapped into the tile, or clamped to it.
  Index texel(const TexelClaim& claim) const {
    return first + Index(wrapped_index(wrap.v, claim.y, height)) * Index(width) +
           Index(wrapped_index(wrap.u, claim.x, width));
  }
  /// The texel whose square holds the UV, not wrapped.
  TexelClaim square_at(const Vec2& uv) const;
  /// Number of the texel that is seen at the UV, wherever that lies.
  Index texel_at(const Vec2& uv) const { return texel(square_at(uv)); }
  /// Whether the texel is in the tile or, repeated, around it.
  bool holds(const TexelClaim& claim) const {
    return (wrap.u != Wrap::clamp || (claim.x >= 0 && claim.x < width)) &&
           (wrap.v != Wrap::clamp || (claim.y >= 0 && claim.y < height));
  }
  /// The claim lies in a period of columns that is turned over.
  bool is_turned_x(const TexelClaim& claim) const {
    return wrap.u == Wrap::mirror && periods_before(claim.x, width) % 2 != 0;
  }
  /// The same of rows.
  bool is_turned_y(const TexelClaim& claim) const {
    return wrap.v == Wrap::mirror && periods_before(claim.y, height) % 2 != 0;
  }
  /// How many texels it has.
  Index size() const { return Index(width) * Index(height); }
};

/// Per input face, the texels whose centre lies inside or on its UV triangle (within 1e-9 texel),
/// ordered by row, then column.
///
/// A centre on an edge or vertex shared by several faces of one chart belongs to the lowest face
/// index; a chart without any centre claims the one texel it overlaps most, through the face
/// closest to that texel's centre. Where charts touch, by less than half a texel of overlap, the
/// texel belongs to the chart that covers more of it. A chart is a set of faces connected over
/// edges whose UV indices agree on all sides, in one tile (find_charts()). Faces without UV or
/// surface area are not rasterised.
///
/// A texel that several periods of a repeated or mirrored tile show is shared by those places.
class TexelMap {
 public:
  std::vector<TexelTile> tiles;     ///< at least one
  std::vector<Index> tile_of_face;  ///< into tiles, or kNone; empty = all in the first
  /// How each face reads its tile outside [0,1]; empty = as the tiles say.
  std::vector<WrapModes> face_wraps;
  std::vector<Index> face_offsets;  ///< faces + 1, into claims
  LargeArray<TexelClaim> claims;    ///< those of face f are [face_offsets[f], face_offsets[f + 1])
  /// Per face the surface area of one whole texel, mesh units squared; 0 = not rasterised.
  std::vector<double> texel_area;
  std::vector<Coverage> coverage;    ///< per texel of all tiles
  std::vector<Index> chart_of_face;  ///< chart number, kNone = not rasterised
  Index charts = 0;                  ///< number of charts

  /// Number of the tile that the face's texels are in; of a face without texels, any.
  Index tile_number(Index face) const {
    const Index tile = tile_of_face.empty() ? 0 : tile_of_face[face];
    return tile == kNone ? 0 : tile;
  }
  /// That tile, with the wrap modes of the face.
  TexelTile tile_of(Index face) const {
    TexelTile tile = tiles[tile_number(face)];
    if (!face_wraps.empty()) tile.wrap = face_wraps[face];
    return tile;
  }
  /// Barycentric coordinates of the claim's centre in its face, clamped to the face.
  Vec3 barycentric(Index face, const TexelClaim& claim) const;
  /// Map from pixel coordinates (x right, y down, texel centres at +.5) to the face's barycentric
  /// coordinates: columns are d/dx, d/dy and the value at (0,0). Not clamped.
  const Eigen::Matrix3d& to_barycentric(Index face) const { return to_barycentric_[face]; }

  /// Texels claimed more than once, ascending.
  std::vector<Index> overlapped() const;
  /// Covered texels that are 8-neighbours of another chart's, ascending: bilinear look-ups between
  /// the two mix both charts, and no gutter fits in.
  std::vector<Index> crowded() const;
  /// Median over claims of the square root of the texel's surface area, mesh units: the unit "tx".
  /// \param tile of which alone; kNone = of all
  /// \return 0 if there are no claims
  double median_texel_size(Index tile = kNone) const;

  std::vector<Eigen::Matrix3d> to_barycentric_;  ///< per face; zero where it is not rasterised
};

/// How much of the texture a UV triangle shows at most, 1 being all of it once: its area, less what
/// is cut off. 0 if that is both sides: then it shows no texel twice.
double repeated_area(const std::array<Vec2, 3>& uv, const WrapModes& wrap);

/// What make_texel_map() takes for the atlas.
struct TexelMapOptions {
  WrapModes wrap;           ///< how UVs outside [0,1] are read where materials do not say
  std::vector<bool> faces;  ///< faces that carry the texture; empty = all with UVs
};

/// Find out which texels of a width x height image lie on which face.
///
/// Texel (i, j) has its centre at u = (i + .5) / width, v = 1 - (j + .5) / height. Faces without
/// UVs, with a vertex twice, with a zero-area UV triangle or without surface area
/// (TriangleMesh::is_degenerate()) claim nothing.
/// Outside [0,1] faces read the image as their material says (Material::wrap), else as the options
/// do. With Wrap::clamp, texels outside the image are not claimed. The result does not depend on
/// the number of threads.
/// \pre width and height are in [1, 32768]
/// \pre faces that read the image differently have no UV index in common: see make_uvs_local() and
///   transform_uvs()
/// \throw FaceError<InputError> if a face's UVs are not finite, span more than 2^14 tiles or lie
///   further than 2^30 texels away
/// \throw InputError if more than 2^31 texels are claimed
TexelMap make_texel_map(const TriangleMesh& mesh, int width, int height,
                        const TexelMapOptions& options = {});

/// The same for a surface in several tiles, each face in one. UVs are those of the face's own tile,
/// which is [0,1]. The modes of a tile are for faces whose material says nothing.
/// \param tile_of_face per face, into tiles; kNone = it carries no texture
/// \pre there is a tile, and the tiles have less than 2^32 texels in all
TexelMap make_texel_map(const TriangleMesh& mesh, std::vector<TexelTile> tiles,
                        std::vector<Index> tile_of_face);

}  // namespace onmesh
