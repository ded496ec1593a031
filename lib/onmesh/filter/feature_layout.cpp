#include "onmesh/filter/feature_layout.h"

#include <algorithm>
#include <string>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

/// Without guides: own values are features of their own if sums are of others.
bool has_own_features(const SurfaceTextures& textures, const FilterOptions& options) {
  if (options.kind != FilterKind::bilateral) return false;
  if (options.filter_alpha) return true;
  if (options.iterations > 1 && !options.guides_from_result) return true;
  switch (options.range_space) {
    case RangeSpace::code:
      return some_space(textures) != nullptr;
    case RangeSpace::linear:
      return false;
    default:
      return true;
  }
}

/// \throw OptionError if colours have no such range space
FeatureSlot slot_of(const Guide& guide, const std::vector<MapChannels>& maps, RangeSpace space) {
  FeatureSlot slot;
  slot.guide = &guide;
  switch (guide.kind) {
    case Guide::Kind::own:
      for (int m = 0; m < int(maps.size()); ++m) {
        const MapChannels& map = maps[std::size_t(m)];
        if (guide.map >= 0 && m < guide.map) slot.first_channel += map.channels;
        if (guide.map < 0 || m == guide.map) slot.channels += map.channels;
        if (guide.map < 0 || m == guide.map) slot.is_colour = !map.is_data;
      }
      break;
    case Guide::Kind::images:
      slot.channels = int(guide.textures.tiles[0].image->range_channels().size());
      slot.is_colour =
          guide.meaning == Guide::Meaning::values && !maps_of(guide.textures)[0].is_data;
      break;
    default:
      slot.channels = 3;
  }
  if (slot.is_colour && space == RangeSpace::oklab && slot.channels != 3) {
    throw OptionError("range_space", "oklab is for three channels, and guide " + guide.name +
                                         " has " + std::to_string(slot.channels));
  }
  return slot;
}

}  // namespace

const ColourSpace* some_space(const SurfaceTextures& textures) {
  for (const TextureTile& tile : textures.tiles)
    if (tile.space) return tile.space.get();
  return nullptr;
}

std::vector<MapChannels> maps_of(const SurfaceTextures& textures) {
  if (!textures.maps.empty()) return textures.maps;
  const int channels = int(textures.tiles[0].image->range_channels().size());
  return {{"", channels, channels < 3}};
}

FeatureLayout::FeatureLayout(const SurfaceTextures& textures, const FilterOptions& options) {
  const std::vector<MapChannels> maps = maps_of(textures);
  if (options.guides.empty() && has_own_features(textures, options)) {
    FeatureSlot& own = slots.emplace_back();
    own.channels = int(textures.tiles[0].image->range_channels().size());
    own.is_colour = true;
  }
  for (const Guide& guide : options.guides)
    slots.push_back(slot_of(guide, maps, options.range_space));
  std::stable_partition(slots.begin(), slots.end(),
                        [](const FeatureSlot& slot) { return !slot.is_own_value(); });
  for (FeatureSlot& slot : slots) {
    slot.offset = features;
    features += slot.channels;
    if (!slot.is_own_value()) shared += slot.channels;
  }
}

}  // namespace onmesh
