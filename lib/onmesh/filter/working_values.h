// The texels' values as the filter sums them: straight, in linear light, with features apart.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/large_array.h"
#include "onmesh/filter/feature_layout.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/filter/tile_reader.h"
#include "onmesh/image/texel_values.h"
#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// What the filter computes with, in place of the files' codes. Sums are of linear light; what
/// range weights compare is beside it if it is something else. Where all of that is the codes
/// themselves, nothing is copied.
///
/// Where alpha is filtered, sums are of colours multiplied with alpha, and of alpha itself:
/// straighten() makes the mean colour of their means. Else samples are weighed by alpha.
class WorkingValues {
 public:
  /// Features are not there before compare_own() and, of other guides, add_guides().
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
  /// Whether a covered texel had no straight colour.
  bool was_missing(Index texel) const;
  /// How many covered texels have alpha 0 and yet a colour that is multiplied with it.
  std::uint64_t emission() const { return emission_; }
  /// Log-average over the surface of the luminance read, where there is any; of one of maps_of().
  /// \pre options ask for despiking or for RangeSpace::log
  double mean_light(std::size_t map) const { return mean_light_[map]; }

  /// Luminance of some channels, as luminance() has it.
  /// \param colour of one map
  double luminance_of(const float* colour, int channels) const;

  /// The straight colours of some texels as they were read, before anything was changed: in the
  /// order of channels(), side by side.
  /// \param texels ascending
  void read_straight(const std::vector<Index>& texels, std::vector<float>& colours) const;

  /// Give texels other straight colours, before the next three functions; only where
  /// are_converted().
  /// \param colours as read_straight() has them
  void change(const std::vector<Index>& texels, const std::vector<float>& colours);
  /// Go on with results: texels that have no value stay without. Only where are_converted().
  /// \param compared whether own features are of them, too, from the next compare_own() on
  void take_results(const TexelValues& results, bool compared);
  /// Once straight colours are settled: make what is summed of them, where that is something else.
  void settle();
  /// Once straight colours are settled, and once only: make features of own values.
  void compare_own();

  const FeatureLayout& layout() const { return layout_; }
  /// One slot's features as values that can be summed or looked at; none are compared.
  Colours features(const FeatureSlot& slot) const;
  /// Those of a texel, to be changed.
  float* features_of(Index texel, const FeatureSlot& slot) {
    return packed_.data() + std::size_t(texel) * std::size_t(colours_.stride) + slot.offset;
  }

  /// Turn means of sums into straight colours, followed by alpha where that is filtered, in place.
  /// What is invisible has no colour: it is left at 0.
  void straighten(float* values, std::size_t texels) const;
  /// The same, then into codes, those of the first tile whose codes are others: to tell how large
  /// errors are.
  void encode_means(float* values, std::size_t texels) const;

  /// Bytes that a filter of these textures needs for its working values.
  static double memory(const SurfaceTextures& textures, const FilterOptions& options);

 private:
  template <class Body>
  void over_texels(const Body& body) const;
  void convert();
  void leave_out(const std::vector<float>& sample_weights);
  void put(Index texel, const float* codes, const float* straight);
  void put_codes(Index texel, const float* codes);
  float* straight_of(Index texel);
  bool is_missing(Index texel) const;
  const float* to_rec709() const { return space_ != nullptr ? space_->to_rec709() : nullptr; }
  void find_mean_light();
  double mean_light_of(int first_channel, int channels) const;
  void count_missing();
  void count_emission();

  const SurfaceTextures& textures_;
  const TexelMap& map_;
  const FilterOptions& options_;
  const FeatureLayout layout_;
  const ColourSpace* space_ = nullptr;  ///< of the first tile that has one
  std::vector<int> channels_;
  bool filters_alpha_ = false;
  bool is_converted_ = false;
  bool is_changed_ = false;  ///< straight colours are others than were read
  std::vector<TileReader> readers_;
  LargeArray<float> packed_;
  Colours colours_, straight_;
  std::vector<double> mean_light_;  ///< per map, where it is asked for
  std::vector<float> alpha_;        ///< of the last results, where it is filtered; empty = as read
  std::uint64_t covered_ = 0, missing_ = 0, left_out_ = 0, emission_ = 0;
};

}  // namespace onmesh
