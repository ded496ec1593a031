#include "onmesh/filter/medians.h"

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "onmesh/filter/percentile.h"

namespace onmesh {
namespace {

constexpr int kTogether = 4;  ///< channels
using Channels = Eigen::Array<float, kTogether, 1>;

/// More are not sorted by networks.
constexpr std::size_t kMost = 64;

}  // namespace

/// Merge exchange (Batcher, Sorting networks and their applications, 1968; Knuth, The Art of
/// Computer Programming, algorithm 5.2.2M).
const std::vector<Medians::Exchange>& Medians::network(std::size_t count) {
  if (networks_.size() <= count) networks_.resize(count + 1);
  std::vector<Exchange>& network = networks_[count];
  if (!network.empty() || count < 2) return network;
  const std::size_t top = std::bit_ceil(count) / 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    while (true) {
      for (std::size_t i = 0; i + d < count; ++i)
        if ((i & p) == r) network.emplace_back(i, i + d);
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
  return network;
}

bool Medians::find_by_network(Index texel, std::span<const Index> around, float* out) {
  const std::size_t count = around.size() + 1;
  const int channels = colours_.channels;
  if (count > kMost) return false;
  std::array<Channels, kMost> values;
  for (int first = 0; first < channels; first += kTogether) {
    const int some = std::min(channels - first, kTogether);
    Channels sum = Channels::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const float* const from = colours_.values_of(k == 0 ? texel : around[k - 1]) + first;
      values[k].setZero();
      for (int c = 0; c < some; ++c) values[k][c] = from[c];
      sum += values[k] - values[k];  // NaN if one is not finite
    }
    if (!(sum == 0).all()) return false;
    for (const auto& [low, high] : network(count)) {
      const Channels least = values[low].min(values[high]);
      values[high] = values[low].max(values[high]);
      values[low] = least;
    }
    const Channels& upper = values[count / 2];
    const Channels median = count % 2 == 1 ? upper : Channels((values[count / 2 - 1] + upper) / 2);
    for (int c = 0; c < some; ++c) out[first + c] = median[c];
  }
  return true;
}

void Medians::find_one(Index texel, std::span<const Index> around, std::size_t channel,
                       float* out) {
  values_.clear();
  const auto add = [&](Index t) {
    const float value = colours_.values_of(t)[channel];
    if (std::isfinite(value)) values_.push_back(value);
  };
  add(texel);
  for (const Index t : around) add(t);
  out[channel] = values_.empty() ? std::numeric_limits<float>::quiet_NaN() : median_of(values_);
}

void Medians::find(Index texel, std::span<const Index> around, float* out) {
  if (find_by_network(texel, around, out)) return;
  for (std::size_t c = 0; c < std::size_t(colours_.channels); ++c) find_one(texel, around, c, out);
}

}  // namespace onmesh
