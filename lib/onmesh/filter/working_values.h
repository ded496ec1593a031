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

/// What the filter computes with, in place of the files' codes. Sums are of linear light; what the
/// range weight compares is beside it if it is something else. Where all of that is the codes
/// themselves, nothing is copied.
///
/// Where alpha is filtered, sums are of colours multiplied with alpha, and of alpha itself:
/// straighten() makes the mean colour of their means. Else samples are weighed by alpha.
class WorkingValues {
 public:
  /// \param sample_weights per texel, see chart_mask(): those of 0 have no value; empty = all 1
  /// \pre the textures and their images, map and options outlive this
  WorkingValues(const SurfaceTextures& textures, const TexelMap& map, const FilterOptions& options,
                const std::vector<float>& sample_weights = {});

  const SurfaceTextures& textures() const { return textures_; }
  const TexelMap& map() const { return map_; }
  /// What is summed.
  const Colours& colours() const { return colours_; }
  /// The colours alone, in linear light and not multiplied with alpha; none are compared.
  const Colours& straight() const { return straight_; }
  /// The images' channels that hold colours.
  const std::vector<int>& channels() const { return channels_; }
  /// Whether values are others than the codes.
  bool are_converted() const { return is_converted_; }
  bool filters_alpha() const { return filters_alpha_; }

  /// How many texels are covered.
  std::uint64_t covered() const { return covered_; }
  /// How many of them have no value, as it is not finite or left out: no samples, and filled.
  std::uint64_t missing() const { return missing_; }
  /// How many of those have a weight of 0.
  std::uint64_t left_out() const { return left_out_; }
  /// How many covered texels have alpha 0 and yet a colour that is multiplied with it.
  std::uint64_t emission() const { return emission_; }

  /// Turn means of sums into straight colours, followed by alpha where that is filtered, in place.
  /// What is invisible has no colour: it is left at 0.
  void straighten(float* values, std::size_t texels) const;
  /// The same, then into codes, those of the first tile whose codes are others: to tell how large
  /// errors are.
  void encode_means(float* values, std::size_t texels) const;

  /// Bytes that a filter of these textures needs for its working values.
  static double memory(const SurfaceTextures& textures, const FilterOptions& options);

 private:
  void convert();
  void leave_out(const std::vector<float>& sample_weights);
  void make_features();
  void multiply_with_alpha();
  double mean_light() const;
  const float* to_rec709() const { return space_ != nullptr ? space_->to_rec709() : nullptr; }
  void count_missing();
  void count_emission();

  const SurfaceTextures& textures_;
  const TexelMap& map_;
  const FilterOptions& options_;
  const ColourSpace* space_ = nullptr;  ///< of the first tile that has one
  std::vector<int> channels_;
  bool filters_alpha_ = false;
  bool is_converted_ = false;
  LargeArray<float> packed_;
  Colours colours_, straight_;
  std::uint64_t covered_ = 0, missing_ = 0, left_out_ = 0, emission_ = 0;
};

}  // namespace onmesh
