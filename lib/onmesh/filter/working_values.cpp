#include "onmesh/filter/working_values.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/range_space.h"

namespace onmesh {
namespace {

bool needs_conversion(const SurfaceTextures& textures, const FilterOptions& options,
                      const FeatureLayout& layout) {
  const bool others =
      std::any_of(textures.tiles.begin(), textures.tiles.end(),
                  [](const TextureTile& t) { return t.premultiplied || t.sample_mask != nullptr; });
  return some_space(textures) != nullptr || others || options.filter_alpha || layout.features > 0 ||
         options.despike > 0 || options.iterations > 1;
}

/// What a texel has in WorkingValues: features, what is summed, straight colours if that is
/// something else.
struct Floats {
  int features, summed, straight;

  Floats(const FeatureLayout& layout, const FilterOptions& options, int channels)
      : features(layout.features),
        summed(channels + (options.filter_alpha ? 1 : 0)),
        straight(options.filter_alpha ? channels : 0) {}
  int all() const { return features + summed + straight; }
};

/// Whether they come before all others of a texel.
bool are_first(const std::vector<int>& channels) {
  return channels.back() == int(channels.size()) - 1;
}

bool are_finite(const float* values, int count) {
  return std::all_of(values, values + count, [](float v) { return std::isfinite(v); });
}

}  // namespace

WorkingValues::WorkingValues(const SurfaceTextures& textures, const TexelMap& map,
                             const FilterOptions& options, const std::vector<float>& sample_weights)
    : textures_(textures),
      map_(map),
      options_(options),
      layout_(textures, options),
      space_(some_space(textures)),
      channels_(textures.tiles[0].image->range_channels()),
      filters_alpha_(options.filter_alpha),
      is_converted_(!sample_weights.empty() || needs_conversion(textures, options, layout_)) {
  const Image& first = *textures.tiles[0].image;
  const auto channels = static_cast<int>(channels_.size());
  const bool compares = options.kind == FilterKind::bilateral;
  if (!is_converted_ && textures.tiles.size() == 1 && are_first(channels_)) {
    colours_ = {first.pixels.data(), channels, compares ? channels : 0, first.channels,
                first.width};
    straight_ = colours_;
  } else {
    const Floats floats(layout_, options, channels);
    const int compared = layout_.features > 0 ? layout_.features : channels;
    packed_.resize(std::size_t(textures.values().size()) * std::size_t(floats.all()));
    colours_ = {packed_.data(), floats.summed, compares ? compared : 0,
                floats.all(),   first.width,   floats.features};
    straight_ = colours_;
    straight_.channels = channels;
    straight_.first_value = floats.all() - (filters_alpha_ ? channels : floats.summed);
    for (const TextureTile& tile : textures.tiles) readers_.emplace_back(tile, channels_);
    convert();
    leave_out(sample_weights);
    find_mean_light();
    settle();
  }
  straight_.range_channels = 0;
  count_missing();
  count_emission();
}

double WorkingValues::memory(const SurfaceTextures& textures, const FilterOptions& options) {
  const std::vector<int> channels = textures.tiles[0].image->range_channels();
  const FeatureLayout layout(textures, options);
  if (!needs_conversion(textures, options, layout) && textures.tiles.size() == 1 &&
      are_first(channels))
    return 0;
  const Floats floats(layout, options, int(channels.size()));
  return floats.all() * double(textures.values().size()) * sizeof(float);
}

/// body(tile, first, texels) for blocks of texels that charts meet: numbers in the tile, whose
/// first texel has the number `first`.
template <class Body>
void WorkingValues::over_texels(const Body& body) const {
  Index first = 0;
  for (const TextureTile& tile : textures_.tiles) {
    const auto count = std::size_t(tile.image->width) * std::size_t(tile.image->height);
    over_blocks(count, [&](std::size_t begin, std::size_t end) {
      std::vector<Index> texels;
      for (std::size_t t = begin; t < end; ++t)
        if (map_.coverage[first + t] != Coverage::none) texels.push_back(Index(t));
      if (!texels.empty()) body(tile, first, texels);
    });
    first += Index(count);
  }
}

void WorkingValues::convert() {
  const std::size_t channels = channels_.size();
  over_texels([&](const TextureTile& tile, Index first, const std::vector<Index>& texels) {
    const TileReader& reader = readers_[std::size_t(&tile - textures_.tiles.data())];
    std::vector<float> codes, light;
    reader.read(texels, codes, light);
    for (std::size_t k = 0; k < texels.size(); ++k)
      put(first + texels[k], &codes[k * channels], &light[k * channels]);
  });
}

float* WorkingValues::straight_of(Index texel) {
  return packed_.data() + std::size_t(texel) * std::size_t(colours_.stride) + straight_.first_value;
}

void WorkingValues::put(Index texel, const float* codes, const float* straight) {
  std::copy_n(straight, channels_.size(), straight_of(texel));
  put_codes(texel, codes);
}

/// Where they are to be compared.
void WorkingValues::put_codes(Index texel, const float* codes) {
  for (const FeatureSlot& slot : layout_.slots)
    if (slot.is_own())
      std::copy_n(codes + slot.first_channel, slot.channels, features_of(texel, slot));
}

bool WorkingValues::is_missing(Index texel) const {
  return !are_finite(colours_.values_of(texel), colours_.channels);
}

bool WorkingValues::was_missing(Index texel) const {
  return !are_finite(straight_.values_of(texel), straight_.channels);
}

void WorkingValues::read_straight(const std::vector<Index>& texels,
                                  std::vector<float>& colours) const {
  colours.clear();
  if (!is_changed_) {
    for (const Index t : texels) {
      const float* const own = straight_.values_of(t);
      colours.insert(colours.end(), own, own + straight_.channels);
    }
    return;
  }
  std::vector<float> codes, light;
  std::vector<Index> own;
  auto next = texels.begin();
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    const TexelTile& tile = map_.tiles[i];
    own.clear();
    for (; next != texels.end() && *next < tile.first + tile.size(); ++next)
      own.push_back(*next - tile.first);
    if (own.empty()) continue;
    readers_[i].read(own, codes, light);
    colours.insert(colours.end(), light.begin(), light.end());
  }
}

void WorkingValues::change(const std::vector<Index>& texels, const std::vector<float>& colours) {
  is_changed_ = true;
  const std::size_t channels = channels_.size();
  std::vector<float> codes(channels);
  for (std::size_t k = 0; k < texels.size(); ++k) {
    const float* const colour = &colours[k * channels];
    std::copy_n(colour, channels, codes.begin());
    const auto next =
        std::upper_bound(map_.tiles.begin(), map_.tiles.end(), texels[k],
                         [](Index t, const TexelTile& tile) { return t < tile.first; });
    const TextureTile& tile = textures_.tiles[std::size_t(next - map_.tiles.begin()) - 1];
    if (tile.space) tile.space->from_linear(codes.data(), 1, int(channels));
    put(texels[k], codes.data(), colour);
  }
}

void WorkingValues::take_results(const TexelValues& results, bool compared) {
  is_changed_ = true;
  const std::size_t channels = channels_.size();
  const int alpha = results.alpha_channel();
  if (filters_alpha_) alpha_.resize(results.size());
  over_texels([&](const TextureTile& tile, Index first, const std::vector<Index>& texels) {
    std::vector<float> codes;
    for (const Index t : texels) {
      const float* const result = results[first + t];
      for (const int c : channels_) codes.push_back(result[c]);
      if (filters_alpha_) alpha_[first + t] = result[alpha];
    }
    const std::vector<float> light = codes;
    if (compared && tile.space) tile.space->from_linear(codes.data(), texels.size(), int(channels));
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const Index texel = first + texels[k];
      if (is_missing(texel)) continue;
      std::copy_n(&light[k * channels], channels, straight_of(texel));
      if (compared) put_codes(texel, &codes[k * channels]);
    }
  });
}

double WorkingValues::luminance_of(const float* colour, int channels) const {
  return luminance(colour, channels, to_rec709());
}

/// Texels that count for nothing have no value.
void WorkingValues::leave_out(const std::vector<float>& sample_weights) {
  if (sample_weights.empty()) return;
  const std::vector<float> nothing(channels_.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t t = 0; t < sample_weights.size(); ++t) {
    if (sample_weights[t] > 0 || map_.coverage[t] != Coverage::covered) continue;
    ++left_out_;
    put(Index(t), nothing.data(), nothing.data());
  }
}

Colours WorkingValues::features(const FeatureSlot& slot) const {
  return {packed_.data() + slot.offset, slot.channels, 0, colours_.stride, colours_.width};
}

void WorkingValues::compare_own() {
  for (const FeatureSlot& slot : layout_.slots) {
    if (!slot.is_own() || !slot.is_colour || options_.range_space == RangeSpace::code) continue;
    const std::size_t map =
        slot.guide != nullptr && slot.guide->map > 0 ? std::size_t(slot.guide->map) : 0;
    const double light = mean_light_.empty() ? 1 : mean_light_[map];
    const RangeFeatures features(options_.range_space, slot.channels, light, to_rec709());
    over_texels([&](const TextureTile&, Index first, const std::vector<Index>& texels) {
      std::vector<float> result(std::size_t(slot.channels));
      for (const Index t : texels) {
        float* const own = features_of(first + t, slot);
        features.of(own, straight_.values_of(first + t) + slot.first_channel, result.data());
        std::copy(result.begin(), result.end(), own);
      }
    });
  }
}

void WorkingValues::settle() {
  if (!filters_alpha_) return;
  const ConstTexelValues codes = textures_.values();
  over_texels([&](const TextureTile&, Index first, const std::vector<Index>& texels) {
    for (const Index of_tile : texels) {
      const Index t = first + of_tile;
      const float alpha = alpha_.empty() ? codes[t][codes.alpha_channel()] : alpha_[t];
      const float* const straight = straight_.values_of(t);
      float* const summed =
          packed_.data() + std::size_t(t) * std::size_t(colours_.stride) + colours_.first_value;
      for (std::size_t c = 0; c < channels_.size(); ++c) summed[c] = straight[c] * alpha;
      // What has no colour has no alpha that counts either.
      summed[channels_.size()] = std::isnan(straight[0]) ? straight[0] : alpha;
    }
  });
}

/// Where something is compared with it.
void WorkingValues::find_mean_light() {
  if (options_.despike == 0 && options_.range_space != RangeSpace::log) return;
  int first = 0;
  for (const MapChannels& map : maps_of(textures_)) {
    mean_light_.push_back(mean_light_of(first, map.channels));
    first += map.channels;
  }
}

double WorkingValues::mean_light_of(int first_channel, int channels) const {
  struct Part {
    double logs = 0, count = 0;
  };
  // By faces, so that sums do not depend on the threads.
  std::vector<Part> parts(map_.face_offsets.size() - 1);
  parallel_over(parts.size(), [&](std::size_t face) {
    const auto f = Index(face);
    Part& part = parts[face];
    for (Index k = map_.face_offsets[f]; k < map_.face_offsets[f + 1]; ++k) {
      const Index texel = map_.tile_of(f).texel(map_.claims[k]);
      const double light = luminance_of(straight_.values_of(texel) + first_channel, channels);
      if (!(light > 0) || !std::isfinite(light)) continue;
      part.logs += std::log(light);
      ++part.count;
    }
  });
  double sum = 0, weight = 0;
  for (Index f = 0; f < parts.size(); ++f) {
    sum += parts[f].logs * map_.texel_area[f];
    weight += parts[f].count * map_.texel_area[f];
  }
  return weight > 0 ? std::exp(sum / weight) : 1;
}

void WorkingValues::count_missing() {
  using Counts = std::array<std::uint64_t, 2>;  // covered, missing
  const Counts counts = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, map_.coverage.size(), 16384), Counts{},
      [&](const tbb::blocked_range<std::size_t>& part, Counts count) {
        for (std::size_t t = part.begin(); t < part.end(); ++t) {
          if (map_.coverage[t] != Coverage::covered) continue;
          ++count[0];
          count[1] += is_missing(Index(t));
        }
        return count;
      },
      [](const Counts& a, const Counts& b) {
        return Counts{a[0] + b[0], a[1] + b[1]};
      });
  covered_ = counts[0];
  missing_ = counts[1];
}

void WorkingValues::count_emission() {
  Index texel = 0;
  for (const TextureTile& tile : textures_.tiles) {
    const Image& image = *tile.image;
    const Index texels = Index(image.width) * Index(image.height);
    for (Index t = 0; t < texels && tile.premultiplied; ++t) {
      const float* const from = image.texel(t);
      if (from[image.alpha_channel] != 0 || map_.coverage[texel + t] != Coverage::covered) continue;
      emission_ += std::any_of(channels_.begin(), channels_.end(),
                               [&](int c) { return std::isfinite(from[c]) && from[c] != 0; });
    }
    texel += texels;
  }
}

void WorkingValues::straighten(float* values, std::size_t texels) const {
  if (!filters_alpha_) return;
  const std::size_t channels = channels_.size();
  for (float* const end = values + texels * (channels + 1); values != end; values += channels + 1) {
    const float alpha = values[channels];
    for (std::size_t c = 0; c < channels; ++c) values[c] = alpha > 0 ? values[c] / alpha : 0;
  }
}

void WorkingValues::encode_means(float* values, std::size_t texels) const {
  straighten(values, texels);
  if (space_ == nullptr) return;
  if (!filters_alpha_) return space_->from_linear(values, texels, int(channels_.size()));
  for (std::size_t t = 0; t < texels; ++t)
    space_->from_linear(values + t * (channels_.size() + 1), 1, int(channels_.size()));
}

}  // namespace onmesh
