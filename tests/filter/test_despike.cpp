// Spikes: values that stick out of those within three texels along the surface.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "support/closed_forms.h"
#include "support/images.h"
#include "support/oracle.h"

namespace onmesh {
namespace {

constexpr int kSize = 40;

/// What despiking alone leaves: a filter that is too narrow to mix texels.
FilterOptions despiking(double factor) {
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = {0.05, Length::Unit::texel};
  options.method = FilterMethod::direct;
  options.gutter = 0;
  options.despike = factor;
  return options;
}

/// Between neighbours linearly.
double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * double(values.size() - 1);
  const auto low = std::size_t(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - double(low)) * (values[high] - values[low]);
}

double luminance_of(const float* rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/// Bright here and there, like light that was sampled a few times.
Image fireflies(int channels, unsigned seed) {
  Image image = make_image(kSize, kSize, channels);
  std::mt19937 random(seed);
  std::exponential_distribution<float> light(1);
  for (Index t = 0; t < kSize * kSize; ++t) {
    const float hot = random() % 23 == 0 ? 60.F : 1.F;
    for (int c = 0; c < channels; ++c) image.texel(t)[c] = (0.3F + light(random)) * hot;
  }
  return image;
}

/// Per texel of a sheet the texels around it, by brute force over its own rasterisation.
std::vector<std::vector<Index>> texels_around(const TriangleMesh& mesh) {
  const TexelPoints all = texel_points(mesh, kSize, kSize);
  const Distances distances = sheet_distances(mesh);
  std::vector<std::vector<Index>> around(kSize * kSize);
  for (std::size_t k = 0; k < all.points.size(); ++k) {
    const double radius = 3 * std::sqrt(all.areas[k]) * (1 + 1e-4);
    const Neighbourhood near = neighbourhood(all, k, radius, distances);
    for (std::size_t i = 0; i < near.near.size(); ++i)
      if (near.near[i] != k && near.distances[i] <= radius)
        around[all.texels[k]].push_back(all.texels[near.near[i]]);
  }
  return around;
}

}  // namespace

TEST_CASE("colours that stick out come down to the median luminance around", "[despike]") {
  const TriangleMesh mesh = GENERATE(make_plane(1, 1), make_folded_sheet(4, 1, 1, 80));
  const Image image = fireflies(3, 1);
  const auto around = texels_around(mesh);
  double logs = 0;
  for (Index t = 0; t < kSize * kSize; ++t) logs += std::log(luminance_of(image.texel(t)));
  const double mean = std::exp(logs / (kSize * kSize));
  Image expected = image;
  std::uint64_t spikes = 0;
  for (Index t = 0; t < kSize * kSize; ++t) {
    std::vector<double> values;
    for (const Index other : around[t]) values.push_back(luminance_of(image.texel(other)));
    const double own = luminance_of(image.texel(t));
    if (values.size() < 6 || own <= 2.5 * percentile(values, 0.8) + 0.001 * mean) continue;
    ++spikes;
    for (int c = 0; c < 3; ++c) expected.texel(t)[c] *= float(percentile(values, 0.5) / own);
  }
  CHECK(spikes > 40);
  FilterReport report;
  const Image result = filter(mesh, image, despiking(2.5), &report);
  CHECK(report.spikes == spikes);
  CHECK(report.mean_after < report.mean_before);
  for (Index t = 0; t < kSize * kSize; ++t)
    for (int c = 0; c < 3; ++c)
      REQUIRE(result.texel(t)[c] == Approx(expected.texel(t)[c]).epsilon(1e-4));
}

TEST_CASE("data that sticks out becomes the median around, each channel by itself", "[despike]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image image = fireflies(2, 3);
  const auto around = texels_around(mesh);
  Image expected = image;
  for (int c = 0; c < 2; ++c) {
    // The robust range: without one in a thousand at either end.
    std::vector<double> all;
    for (Index t = 0; t < kSize * kSize; ++t) all.push_back(image.texel(t)[c]);
    for (Index t = 0; t < kSize * kSize; ++t) {
      std::vector<double> values;
      for (const Index other : around[t]) values.push_back(image.texel(other)[c]);
      const double median = percentile(values, 0.5), own = image.texel(t)[c];
      for (double& v : values) v = std::abs(v - median);
      // .001 of the range are .06 to .3 here: texels so near the limit are left out below.
      const double off = std::abs(own - median) - 3 * percentile(values, 0.8);
      if (off > 0.4) expected.texel(t)[c] = float(median);
      if (off > 0 && off <= 0.4) expected.texel(t)[c] = std::nanf("");
    }
  }
  const Image result = filter(mesh, image, despiking(3));
  std::size_t compared = 0;
  for (std::size_t k = 0; k < result.pixels.size(); ++k) {
    if (std::isnan(expected.pixels[k])) continue;
    ++compared;
    REQUIRE(result.pixels[k] == Approx(expected.pixels[k]).epsilon(1e-4));
  }
  CHECK(compared > result.pixels.size() * 9 / 10);
}

TEST_CASE("spikes that nobody sees stay", "[despike]") {
  Image image = make_image(kSize, kSize, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < kSize * kSize; ++t) {
    for (int c = 0; c < 3; ++c) image.texel(t)[c] = t % 37 == 0 ? 0.9F : 0.1F + float(t % 5) / 100;
    image.texel(t)[3] = t % 37 == 0 ? 0.F : 1.F;
  }
  FilterOptions options = despiking(1.5);
  options.filter_alpha = GENERATE(false, true);
  const Image result = filter(make_plane(1, 1), image, options);
  for (Index t = 0; t < kSize * kSize; t += 37)
    for (int c = 0; c < 3; ++c) CHECK(result.texel(t)[c] == image.texel(t)[c]);
}

TEST_CASE("a hot texel is gone before anything is averaged", "[despike]") {
  Image image = make_image(kSize, kSize, 3);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.5F);
  std::fill_n(image.texel(20 * kSize + 20), 3, 60000.F);
  FilterOptions options = despiking(2.5);
  options.sigma_spatial = {3, Length::Unit::texel};
  for (const float v : filter(make_plane(1, 1), image, options).pixels) REQUIRE(v == Approx(0.5F));
  // What is asked for is a part of the way from what was read.
  options.strength = 0.5;
  const Image half = filter(make_plane(1, 1), image, options);
  CHECK(half.texel(20 * kSize + 20)[0] == Approx(30000.25F));
}

}  // namespace onmesh
