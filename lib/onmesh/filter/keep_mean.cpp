#include "onmesh/filter/keep_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/base/parallel.h"
#include "onmesh/filter/area_mean.h"

namespace onmesh {
namespace {

double mean_of(const float* values, int channels) {
  double sum = 0;
  for (int c = 0; c < channels; ++c) sum += values[c];
  return sum / channels;
}

}  // namespace

/// \param values_of with a texel and what is to be called with its values
template <class ValuesOf>
std::vector<double> SurfaceMeans::means(const ValuesOf& values_of) const {
  std::vector<double> means;
  int first = 0;
  for (const MapChannels& map : maps_of(working_.textures())) {
    means.push_back(area_mean(samples_, [&](const Sample& s) {
      if (working_.was_missing(s.texel)) return std::numeric_limits<double>::quiet_NaN();
      return values_of(s.texel, [&](const float* own) {
        own += first;
        return map.is_data ? mean_of(own, map.channels) : working_.luminance_of(own, map.channels);
      });
    }));
    first += map.channels;
  }
  return means;
}

SurfaceMeans::SurfaceMeans(const WorkingValues& working, const Samples& samples)
    : working_(working), samples_(samples), means_(means([&](Index texel, const auto& use) {
        return use(working.straight().values_of(texel));
      })) {}

void SurfaceMeans::give_to(const TexelValues& results, const ValueRange& range) const {
  const std::vector<int>& channels = working_.channels();
  const std::vector<double> now = means([&](Index texel, const auto& use) {
    thread_local std::vector<float> own;
    own.resize(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) own[c] = results[texel][channels[c]];
    return use(own.data());
  });
  std::vector<float> factors;
  const std::vector<MapChannels> maps = maps_of(working_.textures());
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const double factor = now[m] != 0 && means_[m] / now[m] > 0 ? means_[m] / now[m] : 1;
    factors.insert(factors.end(), std::size_t(maps[m].channels), float(factor));
  }
  over_blocks(results.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (working_.map().coverage[t] != Coverage::covered) continue;
      float* const out = results[Index(t)];
      for (std::size_t c = 0; c < channels.size(); ++c) {
        float& value = out[channels[c]];
        value = std::clamp(value * factors[c], std::min(range.lowest[c], value),
                           std::max(range.highest[c], value));
      }
    }
  });
}

}  // namespace onmesh
