#include "onmesh/measure/light_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/base/parallel.h"

namespace onmesh {
namespace {

/// Keeps errors in the dark from counting without bound.
constexpr double kDark = 0.01;

struct Sums {
  double relative = 0, log_squares = 0, values = 0;

  void add(double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    const double d = a - b;
    const double logs = std::log1p(std::max(a, 0.0)) - std::log1p(std::max(b, 0.0));
    relative += d * d / (b * b + kDark);
    log_squares += logs * logs;
    ++values;
  }
  void add(const Sums& other) {
    relative += other.relative;
    log_squares += other.log_squares;
    values += other.values;
  }
  void add(const LightError& error) {
    relative += error.rel_mse * error.values;
    // No error is an infinity of decibels, which is 0.
    log_squares += std::pow(10, -error.log_psnr / 10) * error.values;
    values += error.values;
  }
  LightError error() const {
    const double n = std::max(values, 1.0);
    return {relative / n,
            log_squares > 0 ? -10 * std::log10(log_squares / n)
                            : std::numeric_limits<double>::infinity(),
            values};
  }
};

struct RowSums {
  Sums colour, alpha;
};

/// Colours of a row, side by side, in linear light.
std::vector<float> light_of_row(const Image& image, const ColourSpace* space, Index y) {
  const std::vector<int> channels = image.range_channels();
  std::vector<float> light;
  light.reserve(std::size_t(image.width) * channels.size());
  for (Index t = y * Index(image.width); t < (y + 1) * Index(image.width); ++t)
    for (const int c : channels) light.push_back(image.texel(t)[c]);
  if (space != nullptr)
    space->to_linear(light.data(), std::size_t(image.width), int(channels.size()));
  return light;
}

}  // namespace

LightDifference light_difference(const Image& a, const Image& b, const ColourSpace* space_a,
                                 const ColourSpace* space_b,
                                 const std::vector<unsigned char>& counted) {
  const std::size_t channels = a.range_channels().size();
  std::vector<RowSums> rows(std::size_t(a.height));
  parallel_over(rows.size(), [&](std::size_t y) {
    const std::vector<float> light_a = light_of_row(a, space_a, Index(y)),
                             light_b = light_of_row(b, space_b, Index(y));
    for (std::size_t x = 0; x < std::size_t(a.width); ++x) {
      const auto texel = Index(y * std::size_t(a.width) + x);
      if (!counted.empty() && counted[texel] == 0) continue;
      for (std::size_t k = x * channels; k < (x + 1) * channels; ++k)
        rows[y].colour.add(light_a[k], light_b[k]);
      if (a.alpha_channel >= 0)
        rows[y].alpha.add(a.texel(texel)[a.alpha_channel], b.texel(texel)[a.alpha_channel]);
    }
  });
  RowSums all;
  for (const RowSums& row : rows) {
    all.colour.add(row.colour);
    all.alpha.add(row.alpha);
  }
  LightDifference result{all.colour.error(), {}};
  if (a.alpha_channel >= 0) result.alpha = all.alpha.error();
  return result;
}

LightDifference together(const std::vector<LightDifference>& parts) {
  Sums colour, alpha;
  bool has_alpha = false;
  for (const LightDifference& part : parts) {
    colour.add(part.colour);
    if (!part.alpha) continue;
    has_alpha = true;
    alpha.add(*part.alpha);
  }
  LightDifference result{colour.error(), {}};
  if (has_alpha) result.alpha = alpha.error();
  return result;
}

}  // namespace onmesh
