// The filter by its definition, in double, with distances that come from elsewhere: the oracle of
// the accuracy tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "onmesh/filter.h"

namespace onmesh {

/// Geodesic distances from one point of the surface to many.
using Distances = std::function<std::vector<double>(const SurfacePoint& source,
                                                    const std::vector<SurfacePoint>& targets)>;

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
  const TexelMap map = make_texel_map(mesh, texture.width, texture.height);
  std::vector<SurfacePoint> points;
  std::vector<Vec3> positions;
  std::vector<Index> texels;
  std::vector<double> areas;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      points.push_back({f, map.barycentric(f, map.claims[k])});
      positions.push_back(mesh.position(points.back()));
      texels.push_back(map.texel(map.claims[k]));
      areas.push_back(map.texel_area[f]);
    }
  }
  std::mt19937 random(42);
  BruteForce out;
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t x = random() % points.size();
    std::vector<std::size_t> near;  // geodesics are not shorter than the straight line
    std::vector<SurfacePoint> targets;
    for (std::size_t y = 0; y < points.size(); ++y) {
      if ((positions[y] - positions[x]).norm() > radius * (1 + 1e-5)) continue;
      near.push_back(y);
      targets.push_back(points[y]);
    }
    const std::vector<double> d = distances(points[x], targets);
    const float* own = texture.texel(texels[x]);
    std::vector<double> sum(static_cast<std::size_t>(texture.channels), 0);
    double weights = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (!(d[k] * d[k] <= radius * radius * (1 + 1e-5))) continue;
      const float* colour = texture.texel(texels[near[k]]);
      double exponent = d[k] * d[k] / (2 * sigma * sigma);
      if (kind == FilterKind::bilateral) {
        double c2 = 0;
        for (int c = 0; c < texture.channels; ++c)
          c2 += std::pow(double(colour[c]) - double(own[c]), 2);
        exponent += c2 / (2 * sigma_range * sigma_range);
      }
      const double w = areas[near[k]] * std::exp(-exponent);
      weights += w;
      ++out.pairs;
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += w * double(colour[c]);
    }
    for (std::size_t c = 0; c < sum.size(); ++c) {
      const double error = sum[c] / weights - double(result.texel(texels[x])[c]);
      squares += error * error;
      out.worst = std::max(out.worst, std::abs(error));
    }
  }
  const double values = double(count) * double(texture.channels);
  out.psnr = 10 * std::log10(values / std::max(squares, 1e-300));
  return out;
}

}  // namespace onmesh
