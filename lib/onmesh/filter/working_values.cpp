#include "onmesh/filter/working_values.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "onmesh/filter/range_space.h"

namespace onmesh {
namespace {

/// Texels that are converted at once.
constexpr std::size_t kBlock = 1024;

/// The first tile whose codes are no amounts of light; null if there is none.
const ColourSpace* some_space(const SurfaceTextures& textures) {
  for (const TextureTile& tile : textures.tiles)
    if (tile.space) return tile.space.get();
  return nullptr;
}

bool has_features(const FilterOptions& options, const ColourSpace* space) {
  if (options.kind != FilterKind::bilateral) return false;
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
  const bool premultiplied = std::any_of(textures.tiles.begin(), textures.tiles.end(),
                                         [](const TextureTile& t) { return t.premultiplied; });
  return some_space(textures) != nullptr || premultiplied || has_features(options, nullptr);
}

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

/// body(begin, end) for blocks of numbers below `size`, on all threads.
template <class Body>
void over_blocks(std::size_t size, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, kBlock),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t begin = range.begin(); begin < range.end(); begin += kBlock)
                        body(begin, std::min(begin + kBlock, range.end()));
                    });
}

}  // namespace

WorkingValues::WorkingValues(const SurfaceTextures& textures, const TexelMap& map,
                             const FilterOptions& options)
    : textures_(textures),
      map_(map),
      options_(options),
      space_(some_space(textures)),
      channels_(textures.tiles[0].image->range_channels()),
      is_converted_(needs_conversion(textures, options)) {
  const Image& first = *textures.tiles[0].image;
  const auto channels = static_cast<int>(channels_.size());
  const int compared = options.kind == FilterKind::bilateral ? channels : 0;
  if (!is_converted_ && textures.tiles.size() == 1 && are_first(channels_)) {
    colours_ = {first.pixels.data(), channels, compared, first.channels, first.width};
  } else {
    const int features = has_features(options, space_) ? channels : 0;
    packed_.resize(std::size_t(textures.values().size()) * std::size_t(features + channels));
    colours_ = {packed_.data(), channels, compared, features + channels, first.width, features};
    convert();
  }
  count_missing();
  count_emission();
}

double WorkingValues::memory(const SurfaceTextures& textures, const FilterOptions& options) {
  const std::vector<int> channels = textures.tiles[0].image->range_channels();
  if (!needs_conversion(textures, options) && textures.tiles.size() == 1 && are_first(channels))
    return 0;
  const double fields =
      double(channels.size()) * (has_features(options, some_space(textures)) ? 2 : 1);
  return fields * double(textures.values().size()) * sizeof(float);
}

/// Straight codes of the filtered channels, side by side.
void WorkingValues::convert() {
  const auto channels = channels_.size(), stride = std::size_t(colours_.stride);
  const auto first_value = std::size_t(colours_.first_value);
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
            if (first_value > 0) texel[c] = code;
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
      if (first_value > 0) {
        for (std::size_t t = begin; t < end; ++t)
          std::copy_n(&light[(t - begin) * channels], channels, to + t * stride);
      }
      if (tile.space) tile.space->to_linear(light.data(), end - begin, int(channels));
      for (std::size_t t = begin; t < end; ++t)
        std::copy_n(&light[(t - begin) * channels], channels, to + t * stride + first_value);
    });
    to += texels * stride;
  }
  if (first_value == 0 || options_.range_space == RangeSpace::code) return;
  const RangeFeatures features(options_.range_space, int(channels), mean_light());
  over_blocks(textures_.values().size(), [&](std::size_t begin, std::size_t end) {
    std::vector<float> result(channels);
    for (std::size_t t = begin; t < end; ++t) {
      if (map_.coverage[t] == Coverage::none) continue;
      float* const texel = packed_.data() + t * stride;
      features.of(texel, texel + first_value, result.data());
      std::copy_n(result.data(), channels, texel);
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
      const double light = luminance(colours_.values_of(texel), colours_.channels);
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
  missing_ = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, map_.coverage.size(), 16384), std::uint64_t{0},
      [&](const tbb::blocked_range<std::size_t>& part, std::uint64_t count) {
        for (std::size_t t = part.begin(); t < part.end(); ++t) {
          if (map_.coverage[t] != Coverage::covered) continue;
          const float* const texel = colours_.of(Index(t));
          count += !std::all_of(texel, texel + colours_.fields(),
                                [](float value) { return std::isfinite(value); });
        }
        return count;
      },
      std::plus<>());
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

void WorkingValues::load(std::vector<Image>& images) const {
  if (!is_converted_) return;
  TexelValues values;
  for (Image& image : images) values.add(image);
  over_blocks(values.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (map_.coverage[t] != Coverage::covered) continue;
      const float* const from = colours_.values_of(Index(t));
      float* const to = values[Index(t)];
      for (std::size_t c = 0; c < channels_.size(); ++c) to[channels_[c]] = from[c];
    }
  });
}

void WorkingValues::encode_values(float* values, std::size_t texels) const {
  if (space_ != nullptr) space_->from_linear(values, texels, int(channels_.size()));
}

void WorkingValues::encode_some(const std::vector<Index>& texels, const TextureTile& tile,
                                const ConstTexelValues& codes, const TexelValues& values) const {
  const std::size_t channels = channels_.size();
  std::vector<float> straight;
  straight.reserve(texels.size() * channels);
  for (const Index t : texels)
    for (const int c : channels_) straight.push_back(values[t][c]);
  if (tile.space) tile.space->from_linear(straight.data(), texels.size(), int(channels));
  const int alpha_channel = tile.image->alpha_channel;
  const float* encoded = straight.data();
  for (const Index t : texels) {
    const float *const before = colours_.values_of(t), *const own = codes[t];
    float* const out = values[t];
    bool is_same = map_.coverage[t] == Coverage::covered;
    for (std::size_t c = 0; c < channels; ++c) {
      const float value = out[channels_[c]];
      if (!is_same) break;
      is_same = value == before[c] || (std::isnan(value) && std::isnan(before[c]));
    }
    const float alpha = tile.premultiplied && own[alpha_channel] > 0 ? own[alpha_channel] : 1;
    for (const int c : channels_) {
      const float code = *encoded++ * alpha;
      out[c] = is_same ? own[c] : code;
    }
  }
}

void WorkingValues::encode(const std::vector<Index>& others, std::vector<Image>& images) const {
  if (!is_converted_) return;
  TexelValues values;
  for (Image& image : images) values.add(image);
  const ConstTexelValues codes = textures_.values();
  Index first = 0;
  auto other = others.begin();
  for (const TextureTile& tile : textures_.tiles) {
    const Index count = Index(tile.image->width) * Index(tile.image->height);
    const auto end_of_others = std::lower_bound(other, others.end(), first + count);
    over_blocks(count, [&](std::size_t begin, std::size_t end) {
      std::vector<Index> covered;
      for (std::size_t t = first + begin; t < first + end; ++t)
        if (map_.coverage[t] == Coverage::covered) covered.push_back(Index(t));
      encode_some(covered, tile, codes, values);
    });
    over_blocks(std::size_t(end_of_others - other), [&](std::size_t begin, std::size_t end) {
      const std::vector<Index> some(other + std::ptrdiff_t(begin), other + std::ptrdiff_t(end));
      encode_some(some, tile, codes, values);
    });
    other = end_of_others;
    first += count;
  }
}

}  // namespace onmesh
