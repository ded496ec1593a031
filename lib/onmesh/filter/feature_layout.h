// Which floats of a texel's working values are features, and whose.
#pragma once

#include <vector>

#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"

namespace onmesh {

/// Features of one guide, side by side.
struct FeatureSlot {
  const Guide* guide = nullptr;  ///< null: own values, without a guide
  int offset = 0;                ///< from the texel's first float
  int channels = 0;
  int first_channel = 0;   ///< own values: the first of them, among those that are filtered
  bool is_colour = false;  ///< compared in FilterOptions::range_space; else codes are

  /// Made of the values that are filtered.
  bool is_own() const { return guide == nullptr || guide->kind == Guide::Kind::own; }
  /// The texel's own values, which it may not have.
  bool is_own_value() const { return is_own() && !(guide != nullptr && guide->is_smoothed()); }
};

/// The slots of a run: first those that every texel has, then the own values.
struct FeatureLayout {
  std::vector<FeatureSlot> slots;
  int features = 0;  ///< of all slots
  int shared = 0;    ///< of those that are not own values

  /// Without guides there are features only where what is compared is not what is summed.
  FeatureLayout(const SurfaceTextures& textures, const FilterOptions& options);
};

/// What the filtered channels are: SurfaceTextures::maps, or the only map there is.
std::vector<MapChannels> maps_of(const SurfaceTextures& textures);

/// The first tile's space whose codes are no amounts of light; null if there is none.
const ColourSpace* some_space(const SurfaceTextures& textures);

}  // namespace onmesh
