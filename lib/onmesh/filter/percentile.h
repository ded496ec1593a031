// Percentiles of a few values.
#pragma once

#include <algorithm>
#include <vector>

namespace onmesh {

/// The value that a share of them is not above, between neighbours linearly; reorders them.
/// \param share 0 to 1
/// \pre there are some
inline float percentile(std::vector<float>& values, double share) {
  const double at = share * double(values.size() - 1);
  const auto low = std::size_t(at);
  const auto middle = values.begin() + std::ptrdiff_t(low);
  std::nth_element(values.begin(), middle, values.end());
  const float below = *middle;
  if (low + 1 == values.size()) return below;
  const float above = *std::min_element(middle + 1, values.end());
  return below + float(at - double(low)) * (above - below);
}

/// The middle value, or the mean of the two in the middle; reorders them.
/// \pre there are some
inline float median_of(std::vector<float>& values) {
  constexpr std::size_t kFew = 24;  // so many are sorted fastest in the simplest way
  if (values.size() > kFew) return percentile(values, 0.5);
  for (std::size_t k = 1; k < values.size(); ++k) {
    const float value = values[k];
    std::size_t at = k;
    for (; at > 0 && values[at - 1] > value; --at) values[at] = values[at - 1];
    values[at] = value;
  }
  const std::size_t upper = values.size() / 2;
  return values.size() % 2 == 1 ? values[upper] : (values[upper - 1] + values[upper]) / 2;
}

}  // namespace onmesh
