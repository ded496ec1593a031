#include "onmesh/atlas/fill_rings.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "onmesh/atlas/charts_of_texels.h"

namespace onmesh {
namespace {

bool has_values(const TexelValues& values, Index texel) {
  const std::vector<int>& channels = values.range_channels();
  return std::all_of(channels.begin(), channels.end(),
                     [at = values[texel]](int c) { return std::isfinite(at[c]); });
}

/// The texel's neighbours in the image that its chart covers.
class Neighbours {
 public:
  explicit Neighbours(const TexelMap& map) : map_(map), charts_(charts_of_texels(map)) {}

  /// Calls with the number of each.
  template <class Call>
  void of(Index texel, const Call& call) const {
    const TexelTile& tile =
        std::upper_bound(map_.tiles.begin(), map_.tiles.end(), texel,
                         [](Index t, const TexelTile& a) { return t < a.first; })[-1];
    const auto x = int((texel - tile.first) % Index(tile.width)),
               y = int((texel - tile.first) / Index(tile.width));
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, tile.height - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, tile.width - 1); ++u) {
        const Index other = tile.first + Index(v) * Index(tile.width) + Index(u);
        if (other != texel && charts_[other] == charts_[texel]) call(other);
      }
    }
  }

 private:
  const TexelMap& map_;
  std::vector<Index> charts_;  ///< per texel, kNone = not covered
};

}  // namespace

std::uint64_t fill_rings(const TexelMap& map, const TexelValues& values) {
  std::vector<Index> empty, clear;
  for (Index t = 0; t < values.size(); ++t) {
    if (map.coverage[t] != Coverage::covered || has_values(values, t)) continue;
    const bool is_clear = values.alpha_channel() >= 0 && values[t][values.alpha_channel()] == 0;
    (is_clear ? clear : empty).push_back(t);
  }
  if (empty.empty()) return 0;
  const Neighbours neighbours(map);
  enum : unsigned char { kFull, kEmpty, kListed };
  std::vector<unsigned char> state(map.coverage.size(), kFull);
  for (const Index t : empty) state[t] = kEmpty;
  for (const Index t : clear) state[t] = kListed;  // they give and get nothing
  std::vector<Index> ring;
  for (const Index t : empty) {
    neighbours.of(t, [&](Index other) {
      if (state[other] != kFull || state[t] == kListed) return;
      state[t] = kListed;
      ring.push_back(t);
    });
  }
  const std::vector<int>& channels = values.range_channels();
  std::uint64_t left = empty.size();
  while (!ring.empty()) {
    std::vector<double> means(ring.size() * channels.size(), 0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      double* const mean = &means[i * channels.size()];
      int found = 0;
      neighbours.of(ring[i], [&](Index other) {
        if (state[other] != kFull) return;
        ++found;
        for (std::size_t c = 0; c < channels.size(); ++c) mean[c] += values[other][channels[c]];
      });
      for (std::size_t c = 0; c < channels.size(); ++c) mean[c] /= found;
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      for (std::size_t c = 0; c < channels.size(); ++c)
        values[ring[i]][channels[c]] = float(means[i * channels.size() + c]);
      state[ring[i]] = kFull;
    }
    left -= ring.size();
    std::vector<Index> next;
    for (const Index t : ring) {
      neighbours.of(t, [&](Index other) {
        if (state[other] != kEmpty) return;
        state[other] = kListed;
        next.push_back(other);
      });
    }
    ring = std::move(next);
  }
  return left;
}

}  // namespace onmesh
