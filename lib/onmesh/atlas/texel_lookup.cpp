#include "onmesh/atlas/texel_lookup.h"

#include <cmath>

namespace onmesh {
namespace {

void add(Index texel, double weight, LookupTexels& found) {
  found.texels[std::size_t(found.count)] = texel;
  found.weights[std::size_t(found.count)] = float(weight);
  ++found.count;
}

}  // namespace

LookupTexels TexelLookup::around(Index face, const Vec2& at) const {
  const TexelTile tile = map_.tile_of(face);
  const int x = int(std::floor(at.x())), y = int(std::floor(at.y()));
  LookupTexels own, any;
  float sum = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const TexelClaim there{x + corner % 2, y + corner / 2};
    const double weight = (1 - std::abs(at.x() - there.x)) * (1 - std::abs(at.y() - there.y));
    if (!(weight > 0)) continue;
    add(tile.texel(there), weight, any);
    if (places_.in_chart_of(face, tile, there) == kNone) continue;
    add(tile.texel(there), weight, own);
    sum += float(weight);
  }
  if (own.count == 0) return any;
  for (float& weight : own.weights) weight /= sum;
  return own;
}

}  // namespace onmesh
