// Values of images between their texels, chart by chart.
#pragma once

#include <array>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/atlas/texel_places.h"

namespace onmesh {

/// What a bilinear look-up reads.
struct LookupTexels {
  std::array<Index, 4> texels{};
  std::array<float, 4> weights{};
  int count = 0;
};

/// Bilinear look-ups among those texels around a place that one chart covers; if there are none,
/// among all.
class TexelLookup {
 public:
  /// \pre map outlives this
  explicit TexelLookup(const TexelMap& map) : map_(map), places_(map) {}

  /// \param face with a tile
  /// \param at in texels of the tile, whose centres are at whole numbers, not wrapped
  /// \return weights with a sum of 1
  LookupTexels around(Index face, const Vec2& at) const;

 private:
  const TexelMap& map_;
  TexelPlaces places_;
};

}  // namespace onmesh
