#include "onmesh/atlas/overlap.h"

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {

OverlapPolicy::OverlapPolicy(Overlap overlap, const TexelMap& map,
                             const std::vector<std::string>& tile_names)
    : overlap_(overlap), texels_(map.overlapped()) {
  if (texels_.empty()) return;
  std::size_t i = map.tiles.size() - 1;
  while (map.tiles[i].first > texels_[0]) --i;
  const Index texel = texels_[0] - map.tiles[i].first, width = Index(map.tiles[i].width);
  first_ = "column " + std::to_string(texel % width) + ", row " + std::to_string(texel / width);
  if (map.tiles.size() > 1) first_ += " of " + tile_names[i];
  if (overlap_ == Overlap::error) throw InputError("overlap=error: " + description());
}

std::string OverlapPolicy::description() const {
  return count_text(texels_.size(), "texel is", "texels are") +
         " claimed by several places of the surface, the first at " + first_;
}

std::string OverlapPolicy::warning() const {
  if (texels_.empty()) return {};
  return description() + (overlap_ == Overlap::average
                              ? "; they get the mean of the results (overlap=average)"
                              : "; they get the first face's result (overlap=first)");
}

TexelMap first_claims(const TexelMap& map) {
  TexelMap first = map;
  std::vector<bool> taken(map.coverage.size(), false);
  first.claims.clear();
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Index texel = map.tile_of(f).texel(map.claims[k]);
      if (!taken[texel]) first.claims.push_back(map.claims[k]);
      taken[texel] = true;
    }
    first.face_offsets[f + 1] = Index(first.claims.size());
  }
  return first;
}

}  // namespace onmesh
