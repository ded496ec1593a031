#include "onmesh/filter/result_values.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// Straight colours turned into codes, side by side.
void to_codes(const TextureTile& tile, std::size_t channels, std::vector<float>& colours) {
  if (tile.space) tile.space->from_linear(colours.data(), colours.size() / channels, int(channels));
}

}  // namespace

ResultValues::ResultValues(const WorkingValues& working, std::vector<Image>& images)
    : working_(working), codes_(working.textures().values()) {
  for (Image& image : images) values_.add(image);
  if (!working.are_converted()) return;
  over_blocks(values_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (working.map().coverage[t] != Coverage::covered) continue;
      const float* from = working.straight().values_of(Index(t));
      float* const to = values_[Index(t)];
      for (const int c : working.channels()) to[c] = *from++;
    }
  });
}

/// body(first, count, tile) for every tile: its texels' numbers begin at `first`.
template <class Body>
void ResultValues::over_tiles(const Body& body) const {
  Index first = 0;
  for (const TextureTile& tile : working_.textures().tiles) {
    const Index count = Index(tile.image->width) * Index(tile.image->height);
    body(first, count, tile);
    first += count;
  }
}

void ResultValues::blend(const FilterOptions& options, const std::vector<float>& mask) const {
  if (options.strength == 1 && options.detail_gain == 0 && mask.empty()) return;
  const std::size_t channels = working_.channels().size();
  over_tiles([&](Index first, Index count, const TextureTile& tile) {
    over_blocks(count, [&](std::size_t begin, std::size_t end) {
      std::vector<float> read;
      const std::vector<Index> covered = covered_texels(first + begin, first + end, read);
      std::vector<Index> known;
      std::vector<float> before;
      for (std::size_t k = 0; k < covered.size(); ++k) {
        const float* const own = &read[k * channels];
        if (working_.was_missing(covered[k])) continue;
        known.push_back(covered[k]);
        before.insert(before.end(), own, own + channels);
      }
      blend_some(known, before, options.strength, mask);
      if (options.detail_gain != 0) add_detail(known, before, tile, options.detail_gain);
    });
  });
}

/// \param read receives their colours as they were read
std::vector<Index> ResultValues::covered_texels(std::size_t begin, std::size_t end,
                                                std::vector<float>& read) const {
  std::vector<Index> covered;
  for (std::size_t t = begin; t < end; ++t)
    if (working_.map().coverage[t] == Coverage::covered) covered.push_back(Index(t));
  working_.read_straight(covered, read);
  return covered;
}

void ResultValues::blend_some(const std::vector<Index>& texels, const std::vector<float>& before,
                              double strength, const std::vector<float>& mask) const {
  const auto mix = [](float from, float to, float share) {
    // The ends are exact.
    return share == 1 ? to : share == 0 ? from : from + share * (to - from);
  };
  const float* in = before.data();
  for (const Index t : texels) {
    const auto share = float(strength) * (mask.empty() ? 1 : mask[t]);
    float* const out = values_[t];
    for (const int c : working_.channels()) {
      out[c] = mix(*in, out[c], share);
      ++in;
    }
    if (!working_.filters_alpha()) continue;
    float& alpha = out[codes_.alpha_channel()];
    alpha = mix(codes_[t][codes_.alpha_channel()], alpha, share);
  }
}

/// In codes, and back into light: the gutter goes on from there.
void ResultValues::add_detail(const std::vector<Index>& texels, const std::vector<float>& read,
                              const TextureTile& tile, double gain) const {
  const std::vector<int>& channels = working_.channels();
  std::vector<float> before = read, after;
  for (const Index t : texels)
    for (const int c : channels) after.push_back(values_[t][c]);
  to_codes(tile, channels.size(), before);
  to_codes(tile, channels.size(), after);
  const bool is_integer = levels_of(*tile.image) > 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    after[i] += float(gain) * (before[i] - after[i]);
    if (is_integer) after[i] = std::clamp(after[i], 0.F, 1.F);
  }
  if (tile.space) tile.space->to_linear(after.data(), texels.size(), int(channels.size()));
  for (std::size_t k = 0; k < texels.size(); ++k) {
    const bool stays = is_as_read(texels[k], &read[k * channels.size()]);
    const float* next = &after[k * channels.size()];
    for (const int c : channels) {
      const float value = *next++;
      if (!stays && std::isfinite(value)) values_[texels[k]][c] = value;
    }
  }
}

/// The texel has the colour that it had.
bool ResultValues::is_as_read(Index texel, const float* read) const {
  const float* const after = values_[texel];
  return std::all_of(working_.channels().begin(), working_.channels().end(), [&](int c) {
    const float was = *read++;
    return was == after[c] || (std::isnan(was) && std::isnan(after[c]));
  });
}

/// What the texel's straight colour is multiplied with in the file.
float ResultValues::alpha_factor(Index texel, const TextureTile& tile) const {
  if (!tile.premultiplied) return 1;
  const int channel = codes_.alpha_channel();
  const float alpha = values_[texel][channel];
  // Colour over alpha 0 is emission and was not divided; unless it is new.
  const bool is_kept = !(codes_[texel][channel] > 0) && !working_.was_missing(texel);
  return is_kept || !(alpha > 0) ? 1 : alpha;
}

/// \param read of covered texels, as they were read; empty = they are no such
void ResultValues::encode_some(const std::vector<Index>& texels, const std::vector<float>& read,
                               const TextureTile& tile) const {
  const std::vector<int>& channels = working_.channels();
  std::vector<float> encoded;
  encoded.reserve(texels.size() * channels.size());
  for (const Index t : texels)
    for (const int c : channels) encoded.push_back(values_[t][c]);
  to_codes(tile, channels.size(), encoded);
  const float* next = encoded.data();
  for (std::size_t k = 0; k < texels.size(); ++k) {
    const Index t = texels[k];
    const float factor = alpha_factor(t, tile);
    const bool was_divided = tile.premultiplied && codes_[t][codes_.alpha_channel()] > 0;
    const float own_factor = was_divided ? codes_[t][codes_.alpha_channel()] : 1;
    // What has no value, as nothing was there to fill it from, stays as well.
    const bool is_known = std::all_of(channels.begin(), channels.end(),
                                      [&](int c) { return std::isfinite(values_[t][c]); });
    const bool stays = !is_known || (factor == own_factor && !read.empty() &&
                                     is_as_read(t, &read[k * channels.size()]));
    for (const int c : channels) {
      const float code = *next++ * factor;
      values_[t][c] = stays ? codes_[t][c] : code;
    }
  }
}

void ResultValues::encode(const std::vector<Index>& others) const {
  if (!working_.are_converted()) return;
  auto other = others.begin();
  over_tiles([&](Index first, Index count, const TextureTile& tile) {
    over_blocks(count, [&](std::size_t begin, std::size_t end) {
      std::vector<float> read;
      const std::vector<Index> covered = covered_texels(first + begin, first + end, read);
      encode_some(covered, read, tile);
    });
    const auto end_of_others = std::lower_bound(other, others.end(), first + count);
    over_blocks(std::size_t(end_of_others - other), [&](std::size_t begin, std::size_t end) {
      const std::vector<Index> some(other + std::ptrdiff_t(begin), other + std::ptrdiff_t(end));
      encode_some(some, {}, tile);
    });
    other = end_of_others;
  });
}

}  // namespace onmesh
