// The filter by its definition, in double, with distances that come from elsewhere: the oracle of
// the accuracy tests and of the comparison of distance back ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "onmesh/filter/filter.h"
#include "onmesh/kernel/radius.h"

namespace onmesh {

/// Geodesic distances from one point of the surface to many; NaN or infinity where there is none.
using Distances = std::function<std::vector<double>(const SurfacePoint& source,
                                                    const std::vector<SurfacePoint>& targets)>;

/// The samples of texel quadrature: every claim of the map, in its order.
struct TexelPoints {
  std::vector<SurfacePoint> points;
  std::vector<Vec3> positions;
  std::vector<Index> texels;
  std::vector<double> areas;
};

inline TexelPoints texel_points(const TriangleMesh& mesh, const TexelMap& map) {
  TexelPoints out;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      out.points.push_back({f, map.barycentric(f, map.claims[k])});
      out.positions.push_back(mesh.position(out.points.back()));
      out.texels.push_back(map.texel(map.claims[k]));
      out.areas.push_back(map.texel_area[f]);
    }
  }
  return out;
}

/// A sample with all others that may lie within a radius, and its distances to them.
struct Neighbourhood {
  std::size_t centre = 0;
  std::vector<std::size_t> near;
  std::vector<double> distances;
};

inline Neighbourhood neighbourhood(const TexelPoints& all, std::size_t centre, double radius,
                                   const Distances& distances) {
  Neighbourhood out;
  out.centre = centre;
  std::vector<SurfacePoint> targets;
  for (std::size_t y = 0; y < all.points.size(); ++y) {
    // Geodesics are not shorter than the straight line.
    if ((all.positions[y] - all.positions[centre]).norm() > radius * kRadiusSlack) continue;
    out.near.push_back(y);
    targets.push_back(all.points[y]);
  }
  out.distances = distances(all.points[centre], targets);
  return out;
}

struct Weights {
  FilterKind kind = FilterKind::bilateral;
  double sigma = 0, radius = 0;  ///< mesh units
  double sigma_range = 0;
};

/// The filter's sums at the neighbourhood's centre, one value per channel.
inline std::vector<double> filtered_value(const TexelPoints& all, const Neighbourhood& around,
                                          const Image& texture, const Weights& weights,
                                          std::size_t* pairs = nullptr) {
  const float* own = texture.texel(all.texels[around.centre]);
  std::vector<double> sum(static_cast<std::size_t>(texture.channels), 0);
  double total = 0;
  for (std::size_t k = 0; k < around.near.size(); ++k) {
    const double squared = around.distances[k] * around.distances[k];
    if (!(squared <= largest_squared(weights.radius))) continue;
    const float* colour = texture.texel(all.texels[around.near[k]]);
    double exponent = squared / (2 * weights.sigma * weights.sigma);
    if (weights.kind == FilterKind::bilateral) {
      double c2 = 0;
      for (int c = 0; c < texture.channels; ++c)
        c2 += std::pow(double(colour[c]) - double(own[c]), 2);
      exponent += c2 / (2 * weights.sigma_range * weights.sigma_range);
    }
    const double w = all.areas[around.near[k]] * std::exp(-exponent);
    total += w;
    if (pairs != nullptr) ++*pairs;
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += w * double(colour[c]);
  }
  for (double& value : sum) value /= total;
  return sum;
}

struct BruteForce {
  double psnr = 0;   ///< dB, peak 1, over the texels tried
  double worst = 0;  ///< largest difference of a value
  std::size_t pairs = 0;
};

/// Compare `result` with the sums of the filter's definition on `count` texels chosen at random
/// with a fixed seed. \pre mesh is welded and clean, no texel is claimed twice, texel quadrature
inline BruteForce against_brute_force(const TriangleMesh& mesh, const Image& texture,
                                      const Image& result, FilterKind kind, double sigma,
                                      double radius, double sigma_range, std::size_t count,
                                      const Distances& distances) {
  const TexelPoints all = texel_points(mesh, make_texel_map(mesh, texture.width, texture.height));
  std::mt19937 random(42);
  BruteForce out;
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Neighbourhood around =
        neighbourhood(all, random() % all.points.size(), radius, distances);
    const std::vector<double> value =
        filtered_value(all, around, texture, {kind, sigma, radius, sigma_range}, &out.pairs);
    for (std::size_t c = 0; c < value.size(); ++c) {
      const double error = value[c] - double(result.texel(all.texels[around.centre])[c]);
      squares += error * error;
      out.worst = std::max(out.worst, std::abs(error));
    }
  }
  const double values = double(count) * double(texture.channels);
  out.psnr = 10 * std::log10(values / std::max(squares, 1e-300));
  return out;
}

}  // namespace onmesh
