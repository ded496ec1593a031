#include "onmesh/atlas/claim_lookup.h"

namespace onmesh {

ClaimLookup::ClaimLookup(const TexelMap& map)
    : map_(map),
      face_of_(map.claims.size()),
      heads_(std::size_t(map.width) * std::size_t(map.height), kNone),
      next_(map.claims.size()) {
  for (Index f = Index(map.face_offsets.size() - 1); f-- > 0;) {
    for (Index claim = map.face_offsets[f + 1]; claim-- > map.face_offsets[f];) {
      Index& head = heads_[map.texel(map.claims[claim])];
      next_[claim] = head;
      head = claim;
      face_of_[claim] = f;
    }
  }
}

Index ClaimLookup::find(Index face, const Vec2& uv) const { return find(face, map_.square_at(uv)); }

Index ClaimLookup::find(Index face, const TexelClaim& square) const {
  if (map_.wrap == Wrap::clamp &&
      (square.x < 0 || square.x >= map_.width || square.y < 0 || square.y >= map_.height))
    return kNone;
  Index claim = heads_[map_.texel(square)];
  for (; claim != kNone; claim = next_[claim]) {
    const TexelClaim& its = map_.claims[claim];
    if (its.x == square.x && its.y == square.y &&
        map_.chart_of_face[face_of_[claim]] == map_.chart_of_face[face])
      break;
  }
  return claim;
}

}  // namespace onmesh
