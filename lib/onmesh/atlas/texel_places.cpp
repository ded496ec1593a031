#include "onmesh/atlas/texel_places.h"

#include <algorithm>

#include "onmesh/base/parallel.h"

namespace onmesh {

TexelPlaces::TexelPlaces(const TexelMap& map)
    : map_(map), faces_(map.coverage.size()), claims_(map.coverage.size()) {
  over_blocks(faces_.size(), [&](std::size_t begin, std::size_t end) {
    std::fill(faces_.begin() + std::ptrdiff_t(begin), faces_.begin() + std::ptrdiff_t(end), kNone);
  });
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    const TexelTile tile = map.tile_of(f);
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Index texel = tile.texel(map.claims[k]);
      if (faces_[texel] != kNone) continue;
      faces_[texel] = f;
      claims_[texel] = map.claims[k];
    }
  }
}

Index TexelPlaces::in_chart_of(Index face, const TexelTile& tile, const TexelClaim& place) const {
  if (!tile.holds(place)) return kNone;
  const Index texel = tile.texel(place);
  const Index other = faces_[texel];
  if (other == kNone || map_.chart_of_face[other] != map_.chart_of_face[face]) return kNone;
  const TexelClaim& claim = claims_[texel];
  return claim.x == place.x && claim.y == place.y ? texel : kNone;
}

}  // namespace onmesh
