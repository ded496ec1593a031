#include "onmesh/atlas/chart_mask.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "onmesh/atlas/texel_lookup.h"
#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

float mask_value(float code) { return code > 0 ? std::min(code, 1.F) : 0.F; }

bool has_size_of(const Image& mask, const TexelTile& tile) {
  return mask.width == tile.width && mask.height == tile.height;
}

/// A mask with the texels that charts cover there.
class MaskLookup {
 public:
  MaskLookup(const TriangleMesh& mesh, const TexelMap& map, const std::vector<const Image*>& masks)
      : map_(map), masks_(masks) {
    bool same_sizes = true;
    std::vector<TexelTile> tiles = map.tiles;
    for (std::size_t i = 0; i < masks.size(); ++i) {
      if (masks[i] == nullptr || has_size_of(*masks[i], tiles[i])) continue;
      tiles[i].width = masks[i]->width;
      tiles[i].height = masks[i]->height;
      same_sizes = false;
    }
    if (same_sizes) return;
    mask_map_ = make_texel_map(mesh, std::move(tiles), map.tile_of_face);
    lookup_.emplace(mask_map_);
  }

  float at(Index face, const TexelClaim& claim) const {
    const Index number = map_.tile_number(face);
    if (masks_[number] == nullptr) return 1;
    const TexelTile tile = map_.tile_of(face);
    const Image& mask = *masks_[number];
    if (has_size_of(mask, tile)) return value(mask, tile.texel(claim) - tile.first);
    const LookupTexels around =
        lookup_->around(face, {(claim.x + 0.5) * mask.width / tile.width - 0.5,
                               (claim.y + 0.5) * mask.height / tile.height - 0.5});
    float sum = 0;
    for (std::size_t k = 0; k < std::size_t(around.count); ++k)
      sum += around.weights[k] * value(mask, around.texels[k] - mask_map_.tiles[number].first);
    return sum;
  }

 private:
  static float value(const Image& mask, Index texel) {
    return mask_value(mask.texel(texel)[mask.alpha_channel == 0 ? 1 : 0]);
  }

  const TexelMap& map_;
  const std::vector<const Image*>& masks_;
  TexelMap mask_map_;  ///< of the same mesh, with the masks' texels; none if sizes agree
  std::optional<TexelLookup> lookup_;  ///< among those texels
};

}  // namespace

std::vector<float> chart_mask(const TriangleMesh& mesh, const TexelMap& map,
                              const std::vector<const Image*>& masks) {
  if (std::all_of(masks.begin(), masks.end(), [](const Image* m) { return m == nullptr; }))
    return {};
  const MaskLookup lookup(mesh, map, masks);
  LargeArray<float> of_claims(map.claims.size());
  parallel_over(map.face_offsets.size() - 1, [&](std::size_t f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k)
      of_claims[k] = lookup.at(Index(f), map.claims[k]);
  });
  // Backwards, so that of a texel's claims the first one stays, whatever the number of threads.
  std::vector<float> values(map.coverage.size(), 1);
  for (auto f = Index(map.face_offsets.size() - 1); f-- > 0;) {
    const TexelTile tile = map.tile_of(f);
    for (Index k = map.face_offsets[f + 1]; k-- > map.face_offsets[f];)
      values[tile.texel(map.claims[k])] = of_claims[k];
  }
  return values;
}

}  // namespace onmesh
