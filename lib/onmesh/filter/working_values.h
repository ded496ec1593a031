// The texels' values as the filter sums them: straight, in linear light, with features apart.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/large_array.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// What the filter computes with, in place of the files' codes. Sums are of linear light, of
/// colours that are not multiplied with alpha; what the range weight compares is beside them if it
/// is something else. Where all of that is the codes themselves, nothing is copied.
class WorkingValues {
 public:
  /// \pre the textures and their images outlive this
  WorkingValues(const SurfaceTextures& textures, const TexelMap& map, const FilterOptions& options);

  const Colours& colours() const { return colours_; }
  /// How many covered texels have a value that is not finite: no samples, and filled.
  std::uint64_t missing() const { return missing_; }
  /// How many covered texels have alpha 0 and yet a colour that is multiplied with it.
  std::uint64_t emission() const { return emission_; }

  /// Put the values of covered texels into copies of the textures.
  void load(std::vector<Image>& images) const;
  /// Turn the values of covered texels and of `others` back into codes. Those that are what they
  /// were get the texture's own codes, bit for bit.
  /// \param others other texels that have working values, ascending
  void encode(const std::vector<Index>& others, std::vector<Image>& images) const;
  /// Turn values into codes in place, those of the first tile whose codes are others: to tell how
  /// large errors are.
  void encode_values(float* values, std::size_t texels) const;

  /// Bytes that a filter of these textures needs for its working values.
  static double memory(const SurfaceTextures& textures, const FilterOptions& options);

 private:
  void convert();
  double mean_light() const;
  void count_missing();
  void count_emission();
  void encode_some(const std::vector<Index>& texels, const TextureTile& tile,
                   const ConstTexelValues& codes, const TexelValues& values) const;

  const SurfaceTextures& textures_;
  const TexelMap& map_;
  const FilterOptions& options_;
  const ColourSpace* space_ = nullptr;  ///< of the first tile that has one
  std::vector<int> channels_;           ///< of the images, those that are filtered
  bool is_converted_ = false;           ///< else the codes are the values
  LargeArray<float> packed_;
  Colours colours_;
  std::uint64_t missing_ = 0, emission_ = 0;
};

}  // namespace onmesh
