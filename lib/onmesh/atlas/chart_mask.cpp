#include "onmesh/atlas/chart_mask.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "onmesh/atlas/texel_places.h"
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
    places_.emplace(mask_map_);
  }

  float at(Index face, const TexelClaim& claim) const {
    const Index number = map_.tile_number(face);
    if (masks_[number] == nullptr) return 1;
    const TexelTile tile = map_.tile_of(face);
    const Image& mask = *masks_[number];
    if (has_size_of(mask, tile)) return value(mask, tile.texel(claim) - tile.first);
    return bilinear(face, mask,
                    {(claim.x + 0.5) * mask.width / tile.width - 0.5,
                     (claim.y + 0.5) * mask.height / tile.height - 0.5});
  }

 private:
  static float value(const Image& mask, Index texel) {
    return mask_value(mask.texel(texel)[mask.alpha_channel == 0 ? 1 : 0]);
  }

  /// \param at in texels of the mask, whose centres are at whole numbers
  float bilinear(Index face, const Image& mask, const Vec2& at) const {
    const TexelTile tile = mask_map_.tile_of(face);
    const int x = int(std::floor(at.x())), y = int(std::floor(at.y()));
    double own = 0, own_weight = 0, any = 0, any_weight = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const TexelClaim there{x + corner % 2, y + corner / 2};
      const double weight = (1 - std::abs(at.x() - there.x)) * (1 - std::abs(at.y() - there.y));
      if (!(weight > 0)) continue;
      const double v = weight * value(mask, tile.texel(there) - tile.first);
      any += v;
      any_weight += weight;
      if (places_->in_chart_of(face, tile, there) == kNone) continue;
      own += v;
      own_weight += weight;
    }
    return float(own_weight > 0 ? own / own_weight : any / any_weight);
  }

  const TexelMap& map_;
  const std::vector<const Image*>& masks_;
  TexelMap mask_map_;  ///< of the same mesh, with the masks' texels; none if sizes agree
  std::optional<TexelPlaces> places_;  ///< of those texels
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
