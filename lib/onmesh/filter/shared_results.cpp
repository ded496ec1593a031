#include "onmesh/filter/shared_results.h"

#include <algorithm>
#include <numeric>

namespace onmesh {

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
