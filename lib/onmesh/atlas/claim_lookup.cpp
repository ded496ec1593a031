#include "onmesh/atlas/claim_lookup.h"

namespace onmesh {

ClaimLookup::ClaimLookup(const TexelMap& map)
    : map_(map),
      face_of_(map.claims.size()),
      heads_(map.coverage.size(), kNone),
      next_(map.claims.size()) {
  for (Index f = Index(map.face_offsets.size() - 1); f-- > 0;) {
    for (Index claim = map.face_offsets[f + 1]; claim-- > map.face_offsets[f];) {
      Index& head = heads_[map.tile_of(f).texel(map.claims[claim])];
      next_[claim] = head;
      head = claim;
      face_of_[claim] = f;
    }
  }
}

Index ClaimLookup::find(Index face, const Vec2& uv) const {
  return find(face, map_.tile_of(face).square_at(uv));
}

Index ClaimLookup::find(Index face, const TexelClaim& square) const {
  const TexelTile tile = map_.tile_of(face);
  if (!tile.holds(square)) return kNone;
  Index claim = heads_[tile.texel(square)];
  for (; claim != kNone; claim = next_[claim]) {
    const TexelClaim& its = map_.claims[claim];
    if (its.x == square.x && its.y == square.y &&
        map_.chart_of_face[face_of_[claim]] == map_.chart_of_face[face])
      break;
  }
  return claim;
}

}  // namespace onmesh
