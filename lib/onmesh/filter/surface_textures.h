// The textures of a surface: one, or several that are filtered together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/colour_space.h"
#include "onmesh/image/image.h"
#include "onmesh/image/lookup.h"
#include "onmesh/image/texel_values.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct FilterOptions;  // options.h

/// One of them: that of a material, or a UDIM tile.
struct TextureTile {
  const Image* image = nullptr;  ///< outlives the textures
  /// How UVs beyond the tile are read by faces whose material says nothing (Material::wrap).
  WrapModes wrap;
  int column = 0;    ///< of the unit square of UVs that it fills, from u = 0
  int row = 0;       ///< the same from v = 0: UDIM tile 1001 + column + 10 row
  std::string name;  ///< what messages call it; may be empty if it is the only one
  /// What its codes mean as light, which is what sums are of; null: codes are summed as they are.
  std::shared_ptr<const ColourSpace> space = nullptr;
  bool premultiplied = false;  ///< its colours are multiplied with alpha: see is_premultiplied()
  /// By how much results replace what was there, from 0 to 1; null: 1. Of any size, see
  /// chart_mask(). Outlives the textures, as the next.
  const Image* mask = nullptr;
  /// By how much texels count as samples, from 0 to 1; those of 0 have no value, and get one. Null:
  /// 1.
  const Image* sample_mask = nullptr;
};

/// Consecutive channels of all tiles, without alpha, that are a map of their own: only they decide
/// together what is a spike, or how large the noise is.
struct MapChannels {
  std::string name;  ///< what guides call it
  int channels = 0;  ///< how many
  /// Numbers, of which each channel is judged by itself; else colours, which have a luminance.
  bool is_data = false;
};

/// All of them, each with its own size and wrap mode. They are one map: colour flows from one into
/// the other where their faces meet.
struct SurfaceTextures {
  std::vector<TextureTile> tiles;  ///< at least one, with the same channels
  /// Per face of the mesh as given, into tiles; kNone = the face carries no texels. Empty = the
  /// first tile for all faces with UVs.
  std::vector<Index> tile_of_face;
  /// What the channels are, if they are several maps with the same samples; empty = one map, of
  /// data if it has less than three channels.
  std::vector<MapChannels> maps = {};

  /// The values of all texels.
  ConstTexelValues values() const {
    ConstTexelValues values;
    for (const TextureTile& tile : tiles) values.add(*tile.image);
    return values;
  }
};

/// Give every face the UVs of its own tile, which is [0,1] then; faces without a tile lose theirs.
/// Those of different tiles, and those that read their tile beyond its border differently, have no
/// UV index in common afterwards: there charts end. A single tile at the origin that all faces
/// read alike changes nothing.
/// \param tile_of_face of the faces of `mesh`
void make_uvs_local(const std::vector<TextureTile>& tiles, const std::vector<Index>& tile_of_face,
                    TriangleMesh& mesh);

/// The tiles as texel maps have them.
std::vector<TexelTile> texel_tiles(const std::vector<TextureTile>& tiles);

/// The textures of a surface that has one, as `options.wrap` and `options.faces` say.
/// \pre image outlives them
SurfaceTextures one_texture(const Image& image, const FilterOptions& options);

}  // namespace onmesh
