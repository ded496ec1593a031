#include "onmesh/filter/results.h"

#include <hwy/cache_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// The range of the finite values of `count` texels.
/// \param texel_of the k-th of them, or kNone
template <class TexelOf>
ValueRange range_of_texels(const ConstTexelValues& texels, std::size_t count,
                           const TexelOf& texel_of) {
  const std::vector<int>& channels = texels.range_channels();
  // A channel at a time, so that the range stays in registers.
  const auto widen = [&](ValueRange& range, std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      float lowest = range.lowest[c], highest = range.highest[c];
      for (std::size_t k = begin; k < end; ++k) {
        const Index texel = texel_of(k);
        if (texel == kNone) continue;
        const float value = texels[texel][channels[c]];
        if (!std::isfinite(value)) continue;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
      }
      range.lowest[c] = lowest;
      range.highest[c] = highest;
    }
  };
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 16384), empty_range(channels.size()),
      [&](const tbb::blocked_range<std::size_t>& part, ValueRange range) {
        widen(range, part.begin(), part.end());
        return range;
      },
      join);
}

}  // namespace

double ValueRange::extent() const {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (std::size_t c = 0; c < lowest.size(); ++c) {
    low = std::min(low, lowest[c]);
    high = std::max(high, highest[c]);
  }
  return high > low ? double(high) - low : 1;
}

ValueRange value_range(const ConstTexelValues& texels, const TexelMap& map,
                       const Samples* sources) {
  // Covered texels are looked at in the texture's order, which is faster than that of the claims.
  ValueRange range = range_of_texels(texels, map.coverage.size(), [&](std::size_t t) {
    return map.coverage[t] == Coverage::covered ? Index(t) : kNone;
  });
  if (sources == nullptr) return range;
  return join(std::move(range),
              range_of_texels(texels, sources->samples.size(),
                              [&](std::size_t k) { return sources->samples[k].texel; }));
}

Results::Results(const OverlapPolicy& overlap, const Samples& targets, ValueRange range,
                 const TexelValues& texels)
    : targets_(targets),
      range_(std::move(range)),
      texels_(texels),
      shared_(overlap, targets, texels.range_channels().size()) {}

void Results::store(Index begin, Index end, const float* values) {
  const std::vector<int>& channels = texels_.range_channels();
  // Texels of a face are in many rows; none should be waited for by itself.
  for (Index target = begin; target < end; ++target)
    hwy::Prefetch(texels_[targets_.samples[target].texel]);
  const std::vector<Index>& several = shared_.targets();
  auto shared = std::lower_bound(several.begin(), several.end(), begin);
  for (Index target = begin; target < end; ++target, values += channels.size()) {
    if (shared != several.end() && *shared == target) {
      shared_.keep(std::size_t(shared - several.begin()), values);
      ++shared;
    } else {
      write(targets_.samples[target].texel, values);
    }
  }
}

void Results::merge_shared() {
  shared_.merge([&](Index texel, const float* values) { write(texel, values); });
}

/// Rounding must not leave the samples' range; texels with a value that is not finite stay. Sums
/// may overflow where values are as large as single precision has them: these texels stay as well.
void Results::write(Index texel, const float* values) {
  const std::vector<int>& channels = texels_.range_channels();
  float* const out = texels_[texel];  // as the texture has it
  bool is_finite = true;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    is_finite &= std::isfinite(out[channels[c]]) && std::isfinite(values[c]);
  }
  if (!is_finite) return;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    out[channels[c]] = std::clamp(values[c], range_.lowest[c], range_.highest[c]);
  }
}

}  // namespace onmesh
