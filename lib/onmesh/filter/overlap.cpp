#include "onmesh/filter/overlap.h"

#include <algorithm>
#include <numeric>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {

OverlapPolicy::OverlapPolicy(Overlap overlap, const TexelMap& map, const SurfaceTextures& textures)
    : overlap_(overlap), texels_(map.overlapped()) {
  if (texels_.empty()) return;
  std::size_t i = map.tiles.size() - 1;
  while (map.tiles[i].first > texels_[0]) --i;
  const Index texel = texels_[0] - map.tiles[i].first, width = Index(map.tiles[i].width);
  first_ = "column " + std::to_string(texel % width) + ", row " + std::to_string(texel / width);
  if (map.tiles.size() > 1) first_ += " of " + textures.tiles[i].name;
  if (overlap_ == Overlap::error) throw InputError("overlap=error: " + description());
}

std::string OverlapPolicy::description() const {
  return count_text(texels_.size(), "texel is", "texels are") +
         " claimed by several places of the surface, the first at " + first_;
}

std::string OverlapPolicy::warning() const {
  if (texels_.empty()) return {};
  return description() + (overlap_ == Overlap::average
                              ? "; they get the mean of the results (overlap=average)"
                              : "; they get the first face's result (overlap=first)");
}

TexelMap first_claims(const TexelMap& map) {
  TexelMap first = map;
  std::vector<bool> taken(map.coverage.size(), false);
  first.claims.clear();
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Index texel = map.tile_of(f).texel(map.claims[k]);
      if (!taken[texel]) first.claims.push_back(map.claims[k]);
      taken[texel] = true;
    }
    first.face_offsets[f + 1] = Index(first.claims.size());
  }
  return first;
}

SharedResults::SharedResults(const OverlapPolicy& policy, const Samples& targets,
                             std::size_t channels)
    : targets_(targets), channels_(channels) {
  if (!policy.shares()) return;
  std::vector<bool> overlapped(policy.texels().back() + std::size_t(1), false);
  for (const Index t : policy.texels()) overlapped[t] = true;
  for (Index k = 0; k < targets.samples.size(); ++k) {
    const Index texel = targets.samples[k].texel;
    if (texel < overlapped.size() && overlapped[texel]) shared_.push_back(k);
  }
  values_.resize(shared_.size() * channels_);
}

void SharedResults::keep(std::size_t position, const float* values) {
  std::copy_n(values, channels_, values_.begin() + std::ptrdiff_t(position * channels_));
}

void SharedResults::merge(
    const std::function<void(Index texel, const float* values)>& write) const {
  const auto texel = [&](std::size_t k) { return targets_.samples[shared_[k]].texel; };
  std::vector<std::size_t> order(shared_.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return texel(a) < texel(b); });
  std::vector<double> sum(channels_);
  std::vector<float> mean(channels_);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    std::fill(sum.begin(), sum.end(), 0.0);
    double area = 0;
    for (end = begin; end < order.size() && texel(order[end]) == texel(order[begin]); ++end) {
      const double a = targets_.samples[shared_[order[end]]].area;
      area += a;
      for (std::size_t c = 0; c < channels_; ++c) sum[c] += a * values_[order[end] * channels_ + c];
    }
    for (std::size_t c = 0; c < channels_; ++c) mean[c] = static_cast<float>(sum[c] / area);
    write(texel(order[begin]), mean.data());
  }
}

}  // namespace onmesh
