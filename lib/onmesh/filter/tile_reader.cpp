#include "onmesh/filter/tile_reader.h"

#include <cmath>

namespace onmesh {

TileReader::TileReader(const TextureTile& tile, const std::vector<int>& channels)
    : tile_(tile), channels_(channels) {
  const int levels = levels_of(*tile.image);
  if (levels == 0 || !tile.space || !tile.space->is_per_channel() || tile.premultiplied) return;
  levels_ = float(levels);
  for (int code = 0; code <= levels; ++code)
    table_.insert(table_.end(), channels.size(), float(code) / levels_);
  tile.space->to_linear(table_.data(), std::size_t(levels) + 1, int(channels.size()));
}

void TileReader::read(const std::vector<Index>& texels, std::vector<float>& codes,
                      std::vector<float>& light) const {
  const Image& image = *tile_.image;
  const std::size_t channels = channels_.size();
  codes.resize(texels.size() * channels);
  float* to = codes.data();
  for (const Index t : texels) {
    const float* const from = image.texel(t);
    const float alpha = tile_.premultiplied ? from[image.alpha_channel] : 1;
    for (const int c : channels_) *to++ = alpha > 0 ? from[c] / alpha : from[c];
  }
  light = codes;
  if (!tile_.space) return;
  if (table_.empty()) {
    tile_.space->to_linear(light.data(), texels.size(), int(channels));
    return;
  }
  for (float* texel = light.data(); texel != light.data() + light.size(); texel += channels)
    for (std::size_t c = 0; c < channels; ++c) texel[c] = light_of(texel[c], c);
}

/// By the table if it is one of its levels, as the file's own are.
float TileReader::light_of(float code, std::size_t channel) const {
  const float level = code * levels_;
  if (level >= 0 && level <= levels_) {
    const auto nearest = std::size_t(level + 0.5F);
    if (std::abs(level - float(nearest)) <= 2e-7F * levels_)  // rounding
      return table_[nearest * channels_.size() + channel];
  }
  std::vector<float> codes(channels_.size(), code);
  tile_.space->to_linear(codes.data(), 1, int(channels_.size()));
  return codes[channel];
}

}  // namespace onmesh
