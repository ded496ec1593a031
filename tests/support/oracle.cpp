#include "support/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace onmesh {
namespace {

/// A pair counts up to R^2 (1 + 1e-5): many tie at R on regular grids.
double largest_square(double radius) { return radius * radius * (1 + 1e-5); }

/// Whether a texel can be a sample: all values but alpha's are finite.
bool is_usable(const Image& texture, Index texel) {
  for (int c = 0; c < texture.channels; ++c) {
    if (c != texture.alpha_channel && !std::isfinite(texture.texel(texel)[c])) return false;
  }
  return true;
}

double alpha_of(const Image& texture, Index texel) {
  return texture.alpha_channel < 0 ? 1 : double(texture.texel(texel)[texture.alpha_channel]);
}

double sample_weight(const Weights& weights, Index texel) {
  return weights.of_samples.empty() ? 1 : double(weights.of_samples[texel]);
}

double squared_colour_distance(const Image& texture, Index a, Index b) {
  double sum = 0;
  for (int c = 0; c < texture.channels; ++c) {
    if (c == texture.alpha_channel) continue;
    sum += std::pow(double(texture.texel(a)[c]) - double(texture.texel(b)[c]), 2);
  }
  return sum;
}

/// The mean over all samples of a texel, weighted by area.
std::vector<double> value_of_texel(const TexelPoints& all, Index texel, const Image& texture,
                                   const Weights& weights, const Distances& distances,
                                   DefinitionError& counts) {
  std::vector<double> mean(static_cast<std::size_t>(texture.channels), 0);
  double area = 0;
  std::size_t places = 0;
  for (std::size_t x = 0; x < all.texels.size(); ++x) {
    if (all.texels[x] != texel) continue;
    const Neighbourhood around = neighbourhood(all, x, weights.radius, distances);
    const std::vector<double> value = filtered_value(all, around, texture, weights, &counts.pairs);
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += all.areas[x] * value[c];
    area += all.areas[x];
    ++places;
  }
  for (double& value : mean) value /= area;
  counts.shared += places > 1;
  return mean;
}

}  // namespace

double median_texel_size(const TexelPoints& all) {
  std::vector<double> areas = all.areas;
  const auto middle = areas.begin() + std::ptrdiff_t((areas.size() - 1) / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return std::sqrt(*middle);
}

Neighbourhood neighbourhood(const TexelPoints& all, std::size_t centre, double radius,
                            const Distances& distances) {
  Neighbourhood out;
  out.centre = centre;
  std::vector<SurfacePoint> targets;
  for (std::size_t y = 0; y < all.points.size(); ++y) {
    // Geodesics are not shorter than the straight line.
    if ((all.positions[y] - all.positions[centre]).norm() > radius * (1 + 1e-5)) continue;
    out.near.push_back(y);
    targets.push_back(all.points[y]);
  }
  out.distances = distances(all.points[centre], targets);
  return out;
}

std::vector<double> filtered_value(const TexelPoints& all, const Neighbourhood& around,
                                   const Image& texture, const Weights& weights,
                                   std::size_t* pairs) {
  const Index own = all.texels[around.centre];
  const float* const own_values = texture.texel(own);
  std::vector<double> value(own_values, own_values + texture.channels);
  if (alpha_of(texture, own) == 0) return value;
  const bool has_value = is_usable(texture, own) && sample_weight(weights, own) > 0;
  const bool is_compared = weights.sigma_range > 0 && has_value;
  const std::size_t compared = weights.features_each - (has_value ? 0 : weights.own_features);
  std::vector<double> sum(value.size(), 0);
  double total = 0;
  for (std::size_t k = 0; k < around.near.size(); ++k) {
    const double squared = around.distances[k] * around.distances[k];
    if (!(squared <= largest_square(weights.radius))) continue;  // nor NaN
    const std::size_t y = around.near[k];
    if (!is_usable(texture, all.texels[y])) continue;
    double exponent = squared / (2 * weights.sigma * weights.sigma);
    if (is_compared) {
      exponent += squared_colour_distance(texture, own, all.texels[y]) /
                  (2 * weights.sigma_range * weights.sigma_range);
    }
    for (std::size_t f = 0; f < compared; ++f) {
      const double apart = double(weights.features[own * weights.features_each + f]) -
                           weights.features[all.texels[y] * weights.features_each + f];
      exponent += apart * apart / 2;
    }
    const double w = all.areas[y] * std::max(alpha_of(texture, all.texels[y]), 0.0) *
                     sample_weight(weights, all.texels[y]) * std::exp(-exponent);
    total += w;
    if (pairs != nullptr) ++*pairs;
    for (std::size_t c = 0; c < sum.size(); ++c)
      sum[c] += w * double(texture.texel(all.texels[y])[c]);
  }
  // A mean of samples lies within their range, so there is nothing to clamp here.
  for (std::size_t c = 0; c < sum.size(); ++c) {
    if (int(c) != texture.alpha_channel) value[c] = sum[c] / total;
  }
  return value;
}

DefinitionError against_definition(const TriangleMesh& mesh, const Image& texture,
                                   const Image& result, const Weights& weights, std::size_t count,
                                   const Distances& distances) {
  const TexelPoints all = texel_points(mesh, texture.width, texture.height);
  std::mt19937 random(42);
  DefinitionError out;
  double squares = 0, values = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Index texel = all.texels[random() % all.texels.size()];
    const std::vector<double> value = value_of_texel(all, texel, texture, weights, distances, out);
    const bool stays = alpha_of(texture, texel) == 0;
    for (std::size_t c = 0; c < value.size(); ++c) {
      const float before = texture.texel(texel)[c], after = result.texel(texel)[c];
      if (stays || int(c) == texture.alpha_channel) {
        const bool same = before == after || (std::isnan(before) && std::isnan(after));
        if (!same) out.worst = std::numeric_limits<double>::infinity();
        continue;
      }
      const double error = value[c] - double(after);
      squares += error * error;
      ++values;
      // NaN must not pass as small.
      out.worst = std::isnan(error) ? std::numeric_limits<double>::infinity()
                                    : std::max(out.worst, std::abs(error));
    }
  }
  out.psnr = 10 * std::log10(values / std::max(squares, 1e-300));
  return out;
}

}  // namespace onmesh
