#include "onmesh/filter/working_values.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/filter/filter.h"
#include "onmesh/filter/range_space.h"
#include "onmesh/image/image_io.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/images.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A square sheet with one texture, in that colour space.
SurfaceTextures textured(const Image& image, const char* space, const FilterOptions& options = {}) {
  SurfaceTextures textures = one_texture(image, options);
  textures.tiles[0].space = find_colour_space(space);
  return textures;
}

Image filtered(const Image& image, const FilterOptions& options, const char* space = "raw") {
  return filter(make_plane(1, 1), textured(image, space, options), options).front();
}

FilterOptions gaussian(double sigma) {
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.method = FilterMethod::direct;
  options.sigma_spatial = {sigma, Length::Unit::texel};
  return options;
}

/// The definition on a flat sheet: sums over texels, with alpha as weight, of linear light,
/// compared in a range space.
Image by_definition(const Image& image, const FilterOptions& options, const char* space_name,
                    bool with_alpha) {
  const auto space = find_colour_space(space_name);
  const std::vector<int> channels = image.range_channels();
  const std::size_t n = channels.size();
  const double sigma = options.sigma_spatial.value;
  const double radius = (options.kind == FilterKind::bilateral ? 2.5 : 3) * sigma;
  std::vector<float> light, features;
  double logs = 0, lit = 0;
  for (Index t = 0; t < Index(image.width * image.height); ++t) {
    std::vector<float> code;
    for (const int c : channels) code.push_back(image.texel(t)[c]);
    light.insert(light.end(), code.begin(), code.end());
    if (space) space->to_linear(&light[t * n], 1, int(n));
    const double l = luminance(&light[t * n], int(n));
    if (l > 0) logs += std::log(l), ++lit;
    features.insert(features.end(), code.begin(), code.end());
  }
  const RangeFeatures range(options.range_space, int(n), std::exp(logs / std::max(lit, 1.0)));
  for (std::size_t t = 0; t < features.size() / n; ++t) {
    std::vector<float> code(&features[t * n], &features[t * n] + n);
    range.of(code.data(), &light[t * n], &features[t * n]);
  }
  Image result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto own = Index(y * image.width + x);
      std::vector<double> sum(n, 0);
      double weights = 0, alphas = 0, all_weights = 0;
      for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
          const auto other = Index(v * image.width + u);
          const double d2 = (u - x) * (u - x) + (v - y) * (v - y);
          if (d2 > radius * radius * (1 + 1e-6)) continue;
          double exponent = d2 / (2 * sigma * sigma);
          if (options.kind == FilterKind::bilateral) {
            for (std::size_t c = 0; c < n; ++c) {
              const double apart = double(features[own * n + c]) - features[other * n + c];
              exponent +=
                  apart * apart / (2 * options.sigma_range.value * options.sigma_range.value);
            }
          }
          const double alpha = with_alpha ? double(image.texel(other)[image.alpha_channel]) : 1;
          const double w = std::exp(-exponent) * alpha;
          all_weights += std::exp(-exponent);
          alphas += std::exp(-exponent) * alpha;
          weights += w;
          for (std::size_t c = 0; c < n; ++c) sum[c] += w * light[other * n + c];
        }
      }
      if (options.filter_alpha)
        result.texel(own)[image.alpha_channel] = float(alphas / all_weights);
      if (with_alpha && image.texel(own)[image.alpha_channel] == 0) continue;
      std::vector<float> mean;
      for (const double s : sum) mean.push_back(float(s / weights));
      if (space) space->from_linear(mean.data(), 1, int(n));
      for (std::size_t c = 0; c < n; ++c) result.texel(own)[channels[c]] = mean[c];
    }
  }
  return result;
}

}  // namespace

TEST_CASE("the filter averages light, weighed by alpha, compared in any range space",
          "[working_values]") {
  Image image = make_texture(40, 40, Pattern::checker, 0.2, 3, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < 1600; ++t) image.texel(t)[3] = float((t * 7) % 5) / 4;
  FilterOptions options;
  options.sigma_spatial = {2, Length::Unit::texel};
  options.sigma_range = 0.25;
  options.method = FilterMethod::direct;
  options.gutter = 0;
  const char* const space = GENERATE("raw", "sRGB");
  options.range_space =
      GENERATE(RangeSpace::code, RangeSpace::linear, RangeSpace::log, RangeSpace::oklab);
  options.filter_alpha = GENERATE(false, true);
  INFO(space << ", range space " << int(options.range_space));
  CHECK(psnr(filtered(image, options, space), by_definition(image, options, space, true)) > 90);
}

TEST_CASE("light that is averaged in the log range space scales with its input",
          "[working_values]") {
  Image image = make_texture(48, 48, Pattern::checker, 0.3, 3, 3);
  Image bright = image;
  for (float& v : bright.pixels) v *= 64;
  FilterOptions options;
  options.range_space = RangeSpace::log;
  options.method = FilterMethod::direct;
  const Image a = filtered(image, options), b = filtered(bright, options);
  for (std::size_t k = 0; k < a.pixels.size(); ++k)
    REQUIRE(b.pixels[k] == Approx(64 * a.pixels[k]).epsilon(1e-5).margin(1e-4));
}

TEST_CASE("bars of black and white average to half the light", "[working_values]") {
  Image image = make_image(64, 64, 3);
  for (Index t = 0; t < 64 * 64; ++t) std::fill_n(image.texel(t), 3, t % 2 == 0 ? 0.0F : 1.0F);
  const Image blurred = filtered(image, gaussian(4), "sRGB");
  CHECK(std::lround(blurred.texel(32 * 64 + 32)[1] * 255) == 188);
  CHECK(std::lround(filtered(image, gaussian(4)).texel(32 * 64 + 32)[1] * 254) == 127);
}

TEST_CASE("an image that was changed since it was read has values between its file's levels",
          "[working_values]") {
  const TempFolder folder;
  const Image flat = make_image(16, 16, 3);
  write_image(folder.path() / "a.png", flat, {false, 8});
  Image read = read_image(folder.path() / "a.png"), made = flat;
  for (Index t = 0; t < 16 * 16; ++t) {
    const float code = t == 100 ? kNan : t == 50 ? 1.5F : float(t) / 256;  // between levels
    for (int c = 0; c < 3; ++c) read.texel(t)[c] = made.texel(t)[c] = code;
  }
  CHECK((filtered(read, gaussian(2), "sRGB").pixels == filtered(made, gaussian(2), "sRGB").pixels));
}

TEST_CASE("texels that stay as they are keep their codes", "[working_values]") {
  Image image = make_texture(32, 32, Pattern::checker, 0.3, 5, 3);
  for (float& code : image.pixels) code = float(std::lround(code * 65535)) / 65535;
  FilterOptions options = gaussian(1e-3);
  options.gutter = 0;
  const Image same = filtered(image, options, "sRGB");
  for (std::size_t k = 0; k < image.pixels.size(); ++k)
    REQUIRE(std::lround(same.pixels[k] * 65535) == std::lround(image.pixels[k] * 65535));
  // Off the surface bit for bit.
  TriangleMesh half = make_plane(1, 1);
  for (Vec2& uv : half.uvs) uv.x() /= 2;
  const Image result = filter(half, textured(image, "sRGB"), gaussian(2)).front();
  for (Index t = 0; t < 32 * 32; ++t) {
    if (t % 32 < 18 || t % 32 >= 30) continue;  // the chart and its gutter
    for (int c = 0; c < 3; ++c) REQUIRE(result.texel(t)[c] == image.texel(t)[c]);
  }
}

TEST_CASE("colours under alpha 0 are nobody's", "[working_values]") {
  Image image = make_image(64, 64, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < 64 * 64; ++t) {
    const bool leaf = t % 64 < 32;
    const float colour[] = {leaf ? 0.8F : 0, leaf ? 0.6F : 0, leaf ? 0.2F : 0, leaf ? 1.F : 0};
    std::copy_n(colour, 4, image.texel(t));
  }
  for (const FilterMethod method : {FilterMethod::direct, FilterMethod::nodes}) {
    FilterOptions options = gaussian(4);
    options.method = method;
    const Image result = filtered(image, options, "sRGB");
    for (Index t = 0; t < 64 * 64; ++t) {
      for (int c = 0; c < 4; ++c)
        REQUIRE(result.texel(t)[c] == Approx(image.texel(t)[c]).margin(1e-4));
    }
  }
}

TEST_CASE("colours multiplied with alpha are averaged straight", "[working_values]") {
  // The same surface, its colours multiplied with alpha or not.
  Image straight = make_texture(48, 48, Pattern::checker, 0.2, 3, 4);
  straight.alpha_channel = 3;
  Image premultiplied = straight;
  for (Index t = 0; t < 48 * 48; ++t) {
    const float alpha = straight.texel(t)[3] = 0.25F + 0.75F * float(t % 3) / 2;
    for (int c = 0; c < 3; ++c) premultiplied.texel(t)[c] = straight.texel(t)[c] * alpha;
    premultiplied.texel(t)[3] = alpha;
  }
  FilterOptions options;
  options.method = FilterMethod::direct;
  SurfaceTextures textures = one_texture(premultiplied, options);
  textures.tiles[0].premultiplied = true;
  const Image a = filtered(straight, options),
              b = filter(make_plane(1, 1), textures, options).front();
  for (Index t = 0; t < 48 * 48; ++t) {
    for (int c = 0; c < 3; ++c)
      REQUIRE(b.texel(t)[c] == Approx(a.texel(t)[c] * straight.texel(t)[3]).margin(1e-5));
    REQUIRE(b.texel(t)[3] == straight.texel(t)[3]);
  }
}

TEST_CASE("values that are not finite do not count and are filled", "[working_values]") {
  Image image = make_texture(64, 64, Pattern::checker, 0.1, 3, 3);
  const Image whole = image;
  const auto kind = GENERATE(FilterKind::gaussian, FilterKind::bilateral);
  const auto method = GENERATE(FilterMethod::direct, FilterMethod::nodes);
  FilterOptions options = gaussian(3);
  options.kind = kind;
  options.method = method;
  // Two texels, and a hole that is wider than the radius.
  const auto in_hole = [](Index t) {
    const int x = int(t % 64) - 40, y = int(t / 64) - 40;
    return x * x + y * y < 14 * 14;
  };
  const Index nan = 10 * 64 + 10, infinite = 12 * 64 + 30;
  image.texel(nan)[1] = kNan;
  image.texel(infinite)[0] = std::numeric_limits<float>::infinity();
  for (Index t = 0; t < 64 * 64; ++t)
    if (in_hole(t)) std::fill_n(image.texel(t), 3, kNan);
  FilterReport report;
  const Image result = filter(make_plane(1, 1), textured(image, "sRGB"), options, &report).front();
  CHECK(report.missing > 600);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Catch::Contains("were filled from around them"));
  float low = 1, high = 0;
  for (const float v : whole.pixels) low = std::min(low, v), high = std::max(high, v);
  for (const float v : result.pixels) {
    REQUIRE(std::isfinite(v));
    REQUIRE(v >= low);
    REQUIRE(v <= high);
  }
  // Far from all of them nothing changes.
  const Image expected = filter(make_plane(1, 1), textured(whole, "sRGB"), options).front();
  for (int c = 0; c < 3; ++c)
    CHECK(result.texel(55 * 64 + 5)[c] == Approx(expected.texel(55 * 64 + 5)[c]).margin(2e-3));
}

TEST_CASE("beside a hot texel values are what they are without it", "[working_values]") {
  Image image = make_image(128, 128, 1);
  image.pixels.assign(image.pixels.size(), 0.25F);
  const Index hot = 90 * 128 + 30;
  image.pixels[hot] = 10000;
  for (const FilterKind kind : {FilterKind::gaussian, FilterKind::bilateral}) {
    for (const FilterMethod method : {FilterMethod::direct, FilterMethod::nodes}) {
      FilterOptions options = gaussian(4);
      options.kind = kind;
      options.method = method;
      const Image result = filtered(image, options);
      for (Index t = 0; t < 128 * 128; ++t) {
        if (std::hypot(int(t % 128) - 30, int(t / 128) - 90) <= 12.01) continue;
        REQUIRE(std::abs(result.pixels[t] - 0.25F) < 1e-5F);
      }
    }
  }
}

TEST_CASE("oklab and luminance know the primaries", "[working_values]") {
  const auto aces = find_colour_space("ACEScg");
  // The green of Rec. 709 in AP1 primaries.
  const float green[] = {0.33953F, 0.91635F, 0.10957F}, in_rec709[] = {0, 1, 0};
  CHECK(luminance(green, 3, aces->to_rec709()) == Approx(0.7152).margin(1e-3));
  float a[3], b[3];
  RangeFeatures(RangeSpace::oklab, 3, 1, aces->to_rec709()).of(green, green, a);
  RangeFeatures(RangeSpace::oklab, 3, 1).of(in_rec709, in_rec709, b);
  for (int c = 0; c < 3; ++c) CHECK(a[c] == Approx(b[c]).margin(5e-3));
}

TEST_CASE("oklab is that of its author's examples", "[working_values]") {
  // White, and the red of sRGB (Ottosson 2020).
  const RangeFeatures oklab(RangeSpace::oklab, 3, 1);
  const float white[] = {1, 1, 1}, red[] = {1, 0, 0};
  float lab[3];
  oklab.of(white, white, lab);
  CHECK(lab[0] == Approx(1).epsilon(1e-4));
  CHECK(lab[1] == Approx(0).margin(1e-4));
  oklab.of(red, red, lab);
  CHECK(lab[0] == Approx(0.628).epsilon(2e-3));
  CHECK(lab[1] == Approx(0.2249).epsilon(2e-3));
  CHECK(lab[2] == Approx(0.1258).epsilon(2e-3));
}

}  // namespace onmesh
