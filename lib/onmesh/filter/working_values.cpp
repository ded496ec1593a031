#include "onmesh/filter/working_values.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/range_space.h"

namespace onmesh {
namespace {

/// The first tile whose codes are no amounts of light; null if there is none.
const ColourSpace* some_space(const SurfaceTextures& textures) {
  for (const TextureTile& tile : textures.tiles)
    if (tile.space) return tile.space.get();
  return nullptr;
}

bool has_features(const FilterOptions& options, const ColourSpace* space) {
  if (options.kind != FilterKind::bilateral) return false;
  if (options.filter_alpha) return true;  // sums are of other values
  switch (options.range_space) {
    case RangeSpace::code:
      return space != nullptr;
    case RangeSpace::linear:
      return false;
    default:
      return true;
  }
}

bool needs_conversion(const SurfaceTextures& textures, const FilterOptions& options) {
  const bool others =
      std::any_of(textures.tiles.begin(), textures.tiles.end(),
                  [](const TextureTile& t) { return t.premultiplied || t.sample_mask != nullptr; });
  return some_space(textures) != nullptr || others || options.filter_alpha ||
         has_features(options, nullptr);
}

/// What a texel has in WorkingValues: features, what is summed, straight colours if that is
/// something else.
struct Layout {
  int features, summed, straight;

  Layout(const FilterOptions& options, const ColourSpace* space, int channels)
      : features(has_features(options, space) ? channels : 0),
        summed(channels + (options.filter_alpha ? 1 : 0)),
        straight(options.filter_alpha ? channels : 0) {}
  int floats() const { return features + summed + straight; }
};

/// Whether they come before all others of a texel.
bool are_first(const std::vector<int>& channels) {
  return channels.back() == int(channels.size()) - 1;
}

/// The linear light of every code of an image of 8 or 16 bits; empty if it is no such image.
std::vector<float> table_of_codes(const TextureTile& tile) {
  const int levels = levels_of(*tile.image);
  if (levels == 0 || !tile.space || !tile.space->is_per_channel() || tile.premultiplied) return {};
  std::vector<float> table;
  for (int code = 0; code <= levels; ++code) table.push_back(float(code) / float(levels));
  tile.space->to_linear(table.data(), table.size(), 1);
  return table;
}

/// The linear light of a code: by the table if it is one of its levels, as the file's own are.
float light_of(float code, const std::vector<float>& table, const ColourSpace& space) {
  const auto levels = float(table.size() - 1);
  const float level = code * levels;
  if (level >= 0 && level < float(table.size())) {
    const auto nearest = std::min(std::size_t(level + 0.5F), table.size() - 1);
    if (std::abs(level - float(nearest)) <= 2e-7F * levels) return table[nearest];  // rounding
  }
  space.to_linear(&code, 1, 1);
  return code;
}

}  // namespace

WorkingValues::WorkingValues(const SurfaceTextures& textures, const TexelMap& map,
                             const FilterOptions& options, const std::vector<float>& sample_weights)
    : textures_(textures),
      map_(map),
      options_(options),
      space_(some_space(textures)),
      channels_(textures.tiles[0].image->range_channels()),
      filters_alpha_(options.filter_alpha),
      is_converted_(!sample_weights.empty() || needs_conversion(textures, options)) {
  const Image& first = *textures.tiles[0].image;
  const auto channels = static_cast<int>(channels_.size());
  const int compared = options.kind == FilterKind::bilateral ? channels : 0;
  if (!is_converted_ && textures.tiles.size() == 1 && are_first(channels_)) {
    colours_ = {first.pixels.data(), channels, compared, first.channels, first.width};
    straight_ = colours_;
  } else {
    const Layout layout(options, space_, channels);
    packed_.resize(std::size_t(textures.values().size()) * std::size_t(layout.floats()));
    colours_ = {packed_.data(),  layout.summed, compared,
                layout.floats(), first.width,   layout.features};
    straight_ = colours_;
    straight_.channels = channels;
    straight_.first_value = layout.floats() - (filters_alpha_ ? channels : layout.summed);
    convert();
    leave_out(sample_weights);
    make_features();
    multiply_with_alpha();
  }
  straight_.range_channels = 0;
  count_missing();
  count_emission();
}

double WorkingValues::memory(const SurfaceTextures& textures, const FilterOptions& options) {
  const std::vector<int> channels = textures.tiles[0].image->range_channels();
  if (!needs_conversion(textures, options) && textures.tiles.size() == 1 && are_first(channels))
    return 0;
  const Layout layout(options, some_space(textures), int(channels.size()));
  return layout.floats() * double(textures.values().size()) * sizeof(float);
}

/// Straight colours of the filtered channels; their codes before them if there are features.
void WorkingValues::convert() {
  const auto channels = channels_.size(), stride = std::size_t(colours_.stride);
  const auto first_value = std::size_t(straight_.first_value);
  const bool has_codes = colours_.first_value > 0;
  float* to = packed_.data();
  for (const TextureTile& tile : textures_.tiles) {
    const Image& image = *tile.image;
    const auto texels = std::size_t(image.width) * std::size_t(image.height);
    const std::vector<float> table = table_of_codes(tile);
    const Coverage* const coverage =
        map_.coverage.data() + std::size_t(to - packed_.data()) / stride;
    over_blocks(texels, [&](std::size_t begin, std::size_t end) {
      if (!table.empty()) {
        for (std::size_t t = begin; t < end; ++t) {
          if (coverage[t] == Coverage::none) continue;  // nobody reads those
          const float* const from = image.texel(Index(t));
          float* const texel = to + t * stride;
          for (std::size_t c = 0; c < channels; ++c) {
            const float code = from[channels_[c]];
            if (has_codes) texel[c] = code;
            texel[first_value + c] = light_of(code, table, *tile.space);
          }
        }
        return;
      }
      std::vector<float> light((end - begin) * channels);
      float* at = light.data();
      for (std::size_t t = begin; t < end; ++t) {
        const float* const from = image.texel(Index(t));
        const float alpha = tile.premultiplied ? from[image.alpha_channel] : 1;
        for (const int c : channels_) *at++ = alpha > 0 ? from[c] / alpha : from[c];
      }
      if (has_codes) {
        for (std::size_t t = begin; t < end; ++t)
          std::copy_n(&light[(t - begin) * channels], channels, to + t * stride);
      }
      if (tile.space) tile.space->to_linear(light.data(), end - begin, int(channels));
      for (std::size_t t = begin; t < end; ++t)
        std::copy_n(&light[(t - begin) * channels], channels, to + t * stride + first_value);
    });
    to += texels * stride;
  }
}

/// Texels that count for nothing have no value.
void WorkingValues::leave_out(const std::vector<float>& sample_weights) {
  if (sample_weights.empty()) return;
  for (std::size_t t = 0; t < sample_weights.size(); ++t) {
    if (sample_weights[t] > 0 || map_.coverage[t] != Coverage::covered) continue;
    ++left_out_;
    float* const texel = packed_.data() + t * std::size_t(colours_.stride);
    std::fill_n(texel, colours_.stride, std::numeric_limits<float>::quiet_NaN());
  }
}

/// What is compared, of the codes that are in its place.
void WorkingValues::make_features() {
  if (colours_.first_value == 0 || options_.range_space == RangeSpace::code) return;
  const auto channels = channels_.size(), stride = std::size_t(colours_.stride);
  const RangeFeatures features(options_.range_space, int(channels), mean_light(), to_rec709());
  over_blocks(textures_.values().size(), [&](std::size_t begin, std::size_t end) {
    std::vector<float> result(channels);
    for (std::size_t t = begin; t < end; ++t) {
      if (map_.coverage[t] == Coverage::none) continue;
      float* const texel = packed_.data() + t * stride;
      features.of(texel, straight_.values_of(Index(t)), result.data());
      std::copy_n(result.data(), channels, texel);
    }
  });
}

/// What is summed where alpha is.
void WorkingValues::multiply_with_alpha() {
  if (!filters_alpha_) return;
  const ConstTexelValues codes = textures_.values();
  over_blocks(codes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (map_.coverage[t] == Coverage::none) continue;
      const float alpha = codes[Index(t)][codes.alpha_channel()];
      const float* const straight = straight_.values_of(Index(t));
      float* const summed =
          packed_.data() + t * std::size_t(colours_.stride) + colours_.first_value;
      for (std::size_t c = 0; c < channels_.size(); ++c) summed[c] = straight[c] * alpha;
      // What has no colour has no alpha that counts either.
      summed[channels_.size()] = std::isnan(straight[0]) ? straight[0] : alpha;
    }
  });
}

/// The log-average of luminance over the surface, of texels that have any.
double WorkingValues::mean_light() const {
  double sum = 0, weight = 0;
  for (Index f = 0; f + 1 < map_.face_offsets.size(); ++f) {
    double logs = 0, count = 0;
    for (Index k = map_.face_offsets[f]; k < map_.face_offsets[f + 1]; ++k) {
      const Index texel = map_.tile_of(f).texel(map_.claims[k]);
      const double light = luminance(straight_.values_of(texel), straight_.channels, to_rec709());
      if (!(light > 0) || !std::isfinite(light)) continue;
      logs += std::log(light);
      ++count;
    }
    sum += logs * map_.texel_area[f];
    weight += count * map_.texel_area[f];
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
          const float* const texel = colours_.of(Index(t));
          ++count[0];
          count[1] += !std::all_of(texel, texel + colours_.fields(),
                                   [](float value) { return std::isfinite(value); });
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
