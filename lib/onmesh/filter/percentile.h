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
inline float median_of(std::vector<float>& values) { return percentile(values, 0.5); }

}  // namespace onmesh
