// Which face claims which texel (internal: a step of make_texel_map()).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/atlas/uv_neighbours.h"
#include "onmesh/atlas/uv_triangle.h"

namespace onmesh {

/// More texels than this are not claimed: offsets have 32 bits.
inline constexpr double kMostClaims = 2147483648.0;

/// The atlas that a texel map is made from. `map` has its tiles, texel areas and charts by now.
struct Atlas {
  const TriangleMesh& mesh;
  TexelMap& map;
  const std::vector<bool>& used;  ///< faces with UVs that carry the texture
  const UvNeighbours& neighbours;
  double tolerance;  ///< pixels

  UvTriangle triangle(Index face) const {
    const TexelTile tile = map.tile_of(face);
    return {mesh, face, tile.width, tile.height, tolerance};
  }
  bool rasterised(Index face) const { return map.texel_area[face] > 0; }
};

/// Limit rows or columns to those that are rasterised: with Wrap::clamp the tile's.
/// \param wrap the mode of their direction
inline void clip(Wrap wrap, std::pair<std::int64_t, std::int64_t>& range, int size) {
  if (wrap != Wrap::clamp) return;
  range.first = std::max<std::int64_t>(range.first, 0);
  range.second = std::min<std::int64_t>(range.second, size);
}

/// Some rows of a face: the piece of work.
struct Strip {
  Index face;
  std::int32_t begin, end;
};

/// All rows of all rasterised faces, ordered by face and row.
std::vector<Strip> make_strips(const Atlas& atlas);

/// Fill in the map's claims and mark their texels covered.
void claim_texels(const Atlas& atlas, const std::vector<Strip>& strips);

}  // namespace onmesh
