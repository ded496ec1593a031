#include "onmesh/filter/noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "onmesh/atlas/charts_of_texels.h"

namespace onmesh {
namespace {

/// Of a Gaussian the median and the mean of absolute values are so much of its standard deviation;
/// the second difference has a standard deviation of the root of 6.
constexpr double kMedianOfGaussian = 0.6745, kMeanOfGaussian = 0.7978845608, kOfDifference = 6;
constexpr Index kEnough = 1 << 18;  ///< texels

/// Reorders them.
/// \pre there are some
double deviation(std::vector<float>& differences, NoiseBy by) {
  if (by == NoiseBy::mean) {
    // Where all is equal nothing was measured: what is fully lit says nothing of the noise
    // elsewhere.
    const auto equal = std::count(differences.begin(), differences.end(), 0.F);
    const double sum = std::accumulate(differences.begin(), differences.end(), 0.0);
    return sum / std::max(double(differences.size()) - double(equal), 1.0) / kMeanOfGaussian;
  }
  const auto middle = differences.begin() + std::ptrdiff_t(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / kMedianOfGaussian;
}

}  // namespace

double noise_of(const Colours& features, const TexelMap& map, NoiseBy by) {
  const std::vector<Index> charts = charts_of_texels(map);
  const auto channels = std::size_t(features.channels);
  std::vector<std::vector<float>> differences(channels);
  const auto add = [&](Index a, Index b, Index c) {
    if (charts[a] != charts[b] || charts[c] != charts[b]) return;
    for (std::size_t k = 0; k < channels; ++k) {
      const float difference =
          features.values_of(a)[k] - 2 * features.values_of(b)[k] + features.values_of(c)[k];
      if (std::isfinite(difference)) differences[k].push_back(std::abs(difference));
    }
  };
  const Index covered = Index(
      std::count_if(charts.begin(), charts.end(), [](Index chart) { return chart != kNone; }));
  const Index step = std::max<Index>(1, covered / kEnough);
  Index number = 0;
  for (const TexelTile& tile : map.tiles) {
    for (Index t = tile.first; t < tile.first + tile.size(); ++t) {
      if (charts[t] == kNone || number++ % step != 0) continue;
      const Index x = (t - tile.first) % Index(tile.width),
                  y = (t - tile.first) / Index(tile.width);
      if (x > 0 && x + 1 < Index(tile.width)) add(t - 1, t, t + 1);
      if (y > 0 && y + 1 < Index(tile.height)) add(t - Index(tile.width), t, t + Index(tile.width));
    }
  }
  double squares = 0;
  for (std::vector<float>& some : differences) {
    if (some.empty()) return 0;
    squares += std::pow(deviation(some, by), 2) / kOfDifference;
  }
  return std::sqrt(squares / double(channels));
}

}  // namespace onmesh
