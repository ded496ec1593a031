#include "onmesh/filter/medians.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "onmesh/base/random.h"

using namespace onmesh;

namespace {

/// By sorting, with what is not finite left out.
float sorted_median(const std::vector<float>& floats, int channels, int channel,
                    std::size_t count) {
  std::vector<float> values;
  for (std::size_t t = 0; t < count; ++t) {
    const float value = floats[t * std::size_t(channels) + std::size_t(channel)];
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return std::numeric_limits<float>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t upper = values.size() / 2;
  return values.size() % 2 == 1 ? values[upper] : (values[upper - 1] + values[upper]) / 2;
}

}  // namespace

TEST_CASE("medians are those of sorted values", "[medians]") {
  SplitMix random(3);
  const int channels = GENERATE(1, 3, 4, 7);
  const bool some_are_odd = GENERATE(false, true);
  for (std::size_t count = 1; count < 90; ++count) {
    std::vector<float> floats(count * std::size_t(channels));
    for (float& f : floats) f = float(std::floor(random.uniform() * 20));  // some are equal
    if (some_are_odd) {
      for (std::size_t k = 0; k < floats.size(); k += 5)
        floats[k] = k % 2 == 0 ? std::numeric_limits<float>::quiet_NaN()
                               : std::numeric_limits<float>::infinity();
    }
    const Colours colours{floats.data(), channels, 0, channels, int(count)};
    std::vector<Index> around(count - 1);
    std::iota(around.begin(), around.end(), 1U);
    std::vector<float> found(std::size_t(channels), 0.F);
    Medians(colours).find(0, around, found.data());
    CAPTURE(count, channels);
    for (int c = 0; c < channels; ++c) {
      const float expected = sorted_median(floats, channels, c, count);
      const float own = found[std::size_t(c)];
      CHECK((own == expected || (std::isnan(own) && std::isnan(expected))));
    }
  }
}
