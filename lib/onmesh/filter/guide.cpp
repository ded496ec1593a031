#include "onmesh/filter/guide.h"

#include <algorithm>

#include "onmesh/filter/options.h"

namespace onmesh {
namespace {

bool have_same_codes(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return false;
  if (a.channels == b.channels && a.alpha_channel == b.alpha_channel) return a.pixels == b.pixels;
  const std::vector<int> own = a.range_channels(), other = b.range_channels();
  if (own.size() != other.size()) return false;
  for (Index t = 0; t < Index(a.width) * Index(a.height); ++t)
    for (std::size_t c = 0; c < own.size(); ++c)
      if (a.texel(t)[own[c]] != b.texel(t)[other[c]]) return false;
  return true;
}

bool have_same_space(const TextureTile& a, const TextureTile& b) {
  const bool both = a.space && b.space;
  return a.premultiplied == b.premultiplied && (a.space == nullptr) == (b.space == nullptr) &&
         (!both || a.space->name() == b.space->name());
}

bool is_texture_itself(const Guide& guide, const SurfaceTextures& textures) {
  return guide.kind == Guide::Kind::images && guide.meaning == Guide::Meaning::values &&
         guide.mesh == nullptr && textures.maps.size() < 2 &&
         guide.textures.tile_of_face == textures.tile_of_face &&
         std::equal(guide.textures.tiles.begin(), guide.textures.tiles.end(),
                    textures.tiles.begin(), textures.tiles.end(),
                    [](const TextureTile& a, const TextureTile& b) {
                      return have_same_space(a, b) && have_same_codes(*a.image, *b.image);
                    });
}

}  // namespace

FilterOptions settle_guides(const SurfaceTextures& textures, FilterOptions options) {
  for (Guide& guide : options.guides)
    if (is_texture_itself(guide, textures)) guide.kind = Guide::Kind::own;
  const bool is_own = options.guides.size() == 1 && options.guides[0].kind == Guide::Kind::own &&
                      !options.guides[0].is_smoothed() && textures.maps.size() < 2;
  if (is_own) {
    options.sigma_range = options.guides[0].width;
    options.guides.clear();
  }
  return options;
}

}  // namespace onmesh
