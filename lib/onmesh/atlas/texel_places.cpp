#include "onmesh/atlas/texel_places.h"

#include <algorithm>
#include <atomic>

#include "onmesh/base/parallel.h"

namespace onmesh {

TexelPlaces::TexelPlaces(const TexelMap& map)
    : map_(map), faces_(map.coverage.size()), claims_(map.coverage.size()) {
  over_blocks(faces_.size(), [&](std::size_t begin, std::size_t end) {
    std::fill(faces_.begin() + std::ptrdiff_t(begin), faces_.begin() + std::ptrdiff_t(end), kNone);
  });
  // Of several claims the lowest face's counts, of those its first.
  const std::size_t faces = map.face_offsets.size() - 1;
  parallel_over(faces, [&](std::size_t f) {
    const TexelTile tile = map.tile_of(Index(f));
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const std::atomic_ref<Index> face(faces_[tile.texel(map.claims[k])]);
      Index before = face.load(std::memory_order_relaxed);
      while (Index(f) < before &&
             !face.compare_exchange_weak(before, Index(f), std::memory_order_relaxed)) {
      }
    }
  });
  parallel_over(faces, [&](std::size_t f) {
    const TexelTile tile = map.tile_of(Index(f));
    for (Index k = map.face_offsets[f + 1]; k-- > map.face_offsets[f];) {
      const Index texel = tile.texel(map.claims[k]);
      if (faces_[texel] == f) claims_[texel] = map.claims[k];
    }
  });
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
