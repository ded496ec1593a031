#include "onmesh/filter/results.h"

#include <hwy/cache_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

ValueRange empty_range(std::size_t channels) {
  return {std::vector<float>(channels, std::numeric_limits<float>::infinity()),
          std::vector<float>(channels, -std::numeric_limits<float>::infinity())};
}

ValueRange join(ValueRange a, const ValueRange& b) {
  for (std::size_t c = 0; c < a.lowest.size(); ++c) {
    a.lowest[c] = std::min(a.lowest[c], b.lowest[c]);
    a.highest[c] = std::max(a.highest[c], b.highest[c]);
  }
  return a;
}

bool has_alpha_0(const ConstTexelValues& texels, Index texel) {
  return texels.alpha_channel() >= 0 && texels[texel][texels.alpha_channel()] == 0;
}

/// The range of the finite values of `count` texels.
/// \param texel_of the k-th of them, or kNone
template <class TexelOf>
ValueRange range_of_texels(const Colours& colours, std::size_t count, const TexelOf& texel_of) {
  const auto channels = std::size_t(colours.channels);
  // A channel at a time, so that the range stays in registers.
  const auto widen = [&](ValueRange& range, std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < channels; ++c) {
      float lowest = range.lowest[c], highest = range.highest[c];
      for (std::size_t k = begin; k < end; ++k) {
        const Index texel = texel_of(k);
        if (texel == kNone) continue;
        const float value = colours.values_of(texel)[c];
        if (!std::isfinite(value)) continue;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
      }
      range.lowest[c] = lowest;
      range.highest[c] = highest;
    }
  };
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 16384), empty_range(channels),
      [&](const tbb::blocked_range<std::size_t>& part, ValueRange range) {
        widen(range, part.begin(), part.end());
        return range;
      },
      join);
}

/// The range of what the texels and samples have; those whose alpha is 0 are left out.
ValueRange range_of(const Colours& colours, const ConstTexelValues& alpha, const TexelMap& map,
                    const Samples* sources) {
  const auto unless_clear = [&](Index texel) { return has_alpha_0(alpha, texel) ? kNone : texel; };
  // Covered texels are looked at in the texture's order, which is faster than that of the claims.
  ValueRange range = range_of_texels(colours, map.coverage.size(), [&](std::size_t t) {
    return map.coverage[t] == Coverage::covered ? unless_clear(Index(t)) : kNone;
  });
  if (sources == nullptr) return range;
  return join(std::move(range),
              range_of_texels(colours, sources->samples.size(), [&](std::size_t k) {
                return unless_clear(sources->samples[k].texel);
              }));
}

/// Rare values are beyond these percentiles.
constexpr double kRare = 0.001;

/// The smallest and largest value that is not rare on the surface, of all channels.
/// \param values_of the values of a texel, in the order of the channels
template <class ValuesOf>
std::pair<double, double> robust_range(const TexelMap& map, const std::vector<int>& channels,
                                       const ValuesOf& values_of) {
  // Rare is one in a thousand: a quarter of a million claims tell.
  constexpr std::size_t kEnough = 1 << 18;
  const std::size_t step = std::max<std::size_t>(1, map.claims.size() / kEnough);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::vector<std::pair<float, float>> weighted;  // values and areas
  for (const int c : channels) {
    weighted.clear();
    double total = 0;
    std::size_t next = 0;
    for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
      for (next = std::max<std::size_t>(next, map.face_offsets[f]); next < map.face_offsets[f + 1];
           next += step) {
        const float value = values_of(map.tile_of(f).texel(map.claims[next]))[c];
        if (!std::isfinite(value)) continue;
        weighted.emplace_back(value, float(map.texel_area[f]));
        total += weighted.back().second;
      }
    }
    if (weighted.empty()) continue;
    std::sort(weighted.begin(), weighted.end());
    double before = 0;
    for (const auto& [value, area] : weighted) {
      if (before <= kRare * total) low = std::min(low, double(value));
      if (before < (1 - kRare) * total) high = std::max(high, double(value));
      before += area;
    }
  }
  return {low, high};
}

/// See robust_extent().
template <class ValuesOf>
double extent_of(const TexelMap& map, const std::vector<int>& channels, const ValuesOf& values_of) {
  const auto [low, high] = robust_range(map, channels, values_of);
  const double largest = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, map.coverage.size(), 16384), 0.0,
      [&](const tbb::blocked_range<std::size_t>& part, double most) {
        for (std::size_t t = part.begin(); t < part.end(); ++t) {
          if (map.coverage[t] != Coverage::covered) continue;
          for (const int c : channels) {
            const double value = std::abs(values_of(Index(t))[c]);
            if (std::isfinite(value)) most = std::max(most, value);
          }
        }
        return most;
      },
      [](double x, double y) { return std::max(x, y); });
  const double extent = std::max(high - low, 1e-6 * largest);
  return extent > 0 ? extent : 1;
}

std::vector<int> all_channels(const Colours& colours) {
  std::vector<int> channels(std::size_t(colours.channels));
  std::iota(channels.begin(), channels.end(), 0);
  return channels;
}

}  // namespace

ValueRange value_range(const WorkingValues& working, const Samples* sources) {
  const ConstTexelValues codes = working.textures().values();
  ValueRange range = range_of(working.straight(), codes, working.map(), sources);
  if (working.filters_alpha()) {
    Colours alpha = working.colours();
    alpha.first_value += alpha.channels - 1;
    alpha.channels = 1;
    const ValueRange of_alpha = range_of(alpha, {}, working.map(), sources);
    range.lowest.push_back(of_alpha.lowest[0]);
    range.highest.push_back(of_alpha.highest[0]);
  }
  return range;
}

double robust_extent(const ConstTexelValues& codes, const TexelMap& map) {
  return robust_extent(codes, codes.range_channels(), map);
}

double robust_extent(const ConstTexelValues& codes, const std::vector<int>& channels,
                     const TexelMap& map) {
  return extent_of(map, channels, [&](Index texel) { return codes[texel]; });
}

double robust_extent(const Colours& colours, const TexelMap& map) {
  return extent_of(map, all_channels(colours), [&](Index t) { return colours.values_of(t); });
}

std::vector<bool> hot_faces(const Colours& colours, const TexelMap& map, const Samples& sources) {
  const auto [low, high] = robust_range(map, all_channels(colours),
                                        [&](Index texel) { return colours.values_of(texel); });
  const double extent = high - low, lowest = low - extent, highest = high + extent;
  std::vector<unsigned char> is_hot(sources.face_offsets.size() - 1, 0);
  parallel_over(is_hot.size(), [&](std::size_t f) {
    for (Index k = sources.face_offsets[f]; k < sources.face_offsets[f + 1] && !is_hot[f]; ++k) {
      const float* const values = colours.values_of(sources.samples[k].texel);
      is_hot[f] = std::any_of(values, values + colours.channels,
                              [&](float value) { return value > highest || value < lowest; });
    }
  });
  const bool are_some = std::find(is_hot.begin(), is_hot.end(), 1) != is_hot.end();
  return are_some ? std::vector<bool>(is_hot.begin(), is_hot.end()) : std::vector<bool>();
}

Results::Results(const OverlapPolicy& overlap, const Samples& targets, const WorkingValues& working,
                 ValueRange range, const TexelValues& texels)
    : targets_(targets),
      working_(working),
      range_(std::move(range)),
      texels_(texels),
      shared_(overlap, targets, std::size_t(working.colours().channels)) {}

void Results::store(Index begin, Index end, const float* values) {
  const auto channels = std::size_t(working_.colours().channels);
  std::vector<float> straight;
  if (working_.filters_alpha()) {
    straight.assign(values, values + std::size_t(end - begin) * channels);
    working_.straighten(straight.data(), end - begin);
    values = straight.data();
  }
  // Texels of a face are in many rows; none should be waited for by itself.
  for (Index target = begin; target < end; ++target)
    hwy::Prefetch(texels_[targets_.samples[target].texel]);
  shared_.store(begin, end, values, [&](Index target, const float* own) {
    write(targets_.samples[target].texel, own);
  });
}

void Results::merge_shared() {
  shared_.merge([&](Index texel, const float* values) { write(texel, values); });
}

/// Rounding must not leave the samples' range. Sums may overflow where values are as large as
/// single precision has them: these texels stay. So do the colours that nothing can be seen of.
void Results::write(Index texel, const float* values) {
  const std::vector<int>& channels = working_.channels();
  float* const out = texels_[texel];  // as the texture has it
  const auto summed = std::size_t(working_.colours().channels);
  if (!std::all_of(values, values + summed, [](float v) { return std::isfinite(v); })) return;
  const int alpha = texels_.alpha_channel();
  const bool was_visible = alpha < 0 || out[alpha] != 0;
  const bool is_visible = !working_.filters_alpha() || values[channels.size()] > 0;
  if (was_visible && is_visible) {
    for (std::size_t c = 0; c < channels.size(); ++c)
      out[channels[c]] = std::clamp(values[c], range_.lowest[c], range_.highest[c]);
  }
  if (working_.filters_alpha()) {
    const std::size_t c = channels.size();
    out[alpha] = std::clamp(values[c], range_.lowest[c], range_.highest[c]);
  }
}

}  // namespace onmesh
