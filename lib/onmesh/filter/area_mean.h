// Means over the surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "onmesh/base/parallel.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// The mean of value_of(sample), weighted by the samples' areas; 0 if there is none. What is not
/// finite does not count. The same for any number of threads.
template <class ValueOf>
double area_mean(const Samples& samples, const ValueOf& value_of) {
  constexpr std::size_t kAtOnce = 4096;
  struct Part {
    double sum = 0, area = 0;
  };
  const std::size_t count = samples.samples.size();
  std::vector<Part> parts((count + kAtOnce - 1) / kAtOnce);
  parallel_over(parts.size(), [&](std::size_t p) {
    Part& part = parts[p];
    const std::size_t end = std::min((p + 1) * kAtOnce, count);
    for (std::size_t k = p * kAtOnce; k < end; ++k) {
      const Sample& s = samples.samples[k];
      const double value = value_of(s);
      if (!std::isfinite(value)) continue;
      part.sum += s.area * value;
      part.area += s.area;
    }
  });
  double sum = 0, area = 0;
  for (const Part& part : parts) {
    sum += part.sum;
    area += part.area;
  }
  return area > 0 ? sum / area : 0;
}

}  // namespace onmesh
