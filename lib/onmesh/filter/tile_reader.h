// The codes of a texture's texels as light.
#pragma once

#include <vector>

#include "onmesh/filter/surface_textures.h"

namespace onmesh {

/// Straight codes and the light they stand for, of one tile's texels. Codes of 8 and 16 bits have a
/// table.
class TileReader {
 public:
  /// \param channels of the image that are read
  /// \pre tile and channels outlive this
  TileReader(const TextureTile& tile, const std::vector<int>& channels);

  /// \param texels of the tile, counted from its first
  /// \param codes, light receive a value per channel for each texel, side by side
  void read(const std::vector<Index>& texels, std::vector<float>& codes,
            std::vector<float>& light) const;

 private:
  float light_of(float code, std::size_t channel) const;

  const TextureTile& tile_;
  const std::vector<int>& channels_;
  float levels_ = 0;
  std::vector<float> table_;  ///< per code the light in each channel; empty = none
};

}  // namespace onmesh
