// Masks, strength and detail: how much of the result is taken, and which texels count.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "onmesh/filter/filter.h"
#include "onmesh/image/colour_space.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/closed_forms.h"
#include "support/images.h"
#include "support/oracle.h"

namespace onmesh {
namespace {

constexpr int kSize = 48;

/// Values in [0,1], a third of them 0 and a third 1.
Image random_mask(unsigned seed) {
  Image mask = make_image(kSize, kSize, 1);
  std::mt19937 random(seed);
  for (float& v : mask.pixels) {
    const auto part = random() % 3;
    v = part == 0 ? 0.F : part == 1 ? 1.F : float(random() % 1000) / 1000;
  }
  return mask;
}

Image rgba() {
  Image image = make_texture(kSize, kSize, Pattern::checker, 0.2, 3, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < kSize * kSize; ++t) image.texel(t)[3] = float((t * 7) % 5) / 4;
  return image;
}

FilterOptions some_options() {
  FilterOptions options;
  options.sigma_spatial = {2, Length::Unit::texel};
  options.sigma_range = 0.25;
  options.method = FilterMethod::direct;
  options.gutter = 0;
  return options;
}

std::vector<Image> run(const Image& image, const FilterOptions& options, const Image* mask,
                       const Image* sample_mask, FilterReport* report = nullptr) {
  SurfaceTextures textures = one_texture(image, options);
  textures.tiles[0].mask = mask;
  textures.tiles[0].sample_mask = sample_mask;
  return filter(make_plane(1, 1), textures, options, report);
}

}  // namespace

TEST_CASE("samples count as their mask, alpha and values say", "[masks][oracle]") {
  const bool folded = GENERATE(false, true);
  const TriangleMesh mesh = folded ? make_folded_sheet(4, 1, 1, 80) : make_plane(1, 1);
  Image image = rgba();
  for (Index t = 5; t < kSize * kSize; t += 97)
    image.texel(t)[t % 3] = std::numeric_limits<float>::quiet_NaN();
  const Image samples = random_mask(8);
  FilterOptions options = some_options();
  options.kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  SurfaceTextures textures = one_texture(image, options);
  textures.tiles[0].sample_mask = &samples;
  FilterReport report;
  const Image result = filter(mesh, textures, options, &report).front();
  CHECK(report.left_out > kSize * kSize / 4);
  Weights weights{report.sigma_spatial, report.radius,
                  options.kind == FilterKind::bilateral ? options.sigma_range.value : 0,
                  samples.pixels};
  const DefinitionError error =
      against_definition(mesh, image, result, weights, 400, sheet_distances(mesh));
  INFO("worst " << error.worst);
  CHECK(error.psnr > 90);
}

TEST_CASE("mask and strength go a part of the way to the result", "[masks]") {
  const Image image = rgba(), mask = random_mask(3);
  FilterOptions options = some_options();
  const Image whole = run(image, options, nullptr, nullptr).front();
  options.strength = 0.7;
  const Image result = run(image, options, &mask, nullptr).front();
  for (Index t = 0; t < kSize * kSize; ++t) {
    const float share = 0.7F * mask.pixels[t];
    for (int c = 0; c < 4; ++c) {
      const float in = image.texel(t)[c], out = result.texel(t)[c];
      if (share == 0) REQUIRE(out == in);
      REQUIRE(out == Approx(in + share * (whole.texel(t)[c] - in)).margin(1e-6));
    }
  }
}

TEST_CASE("texels without a value get one whatever mask and strength say", "[masks]") {
  Image image = make_texture(kSize, kSize, Pattern::checker, 0.2, 3, 3);
  Image samples = make_image(kSize, kSize, 1), mask = samples;  // the mask takes nothing
  std::fill(samples.pixels.begin(), samples.pixels.end(), 1.F);
  const Index nan = 20 * kSize + 20, left_out = 30 * kSize + 7;
  image.texel(nan)[2] = std::numeric_limits<float>::quiet_NaN();
  samples.pixels[left_out] = 0;
  FilterOptions options = some_options();
  const Image filtered = run(image, options, nullptr, &samples).front();
  options.strength = 0.25;
  FilterReport report;
  const Image result = run(image, options, &mask, &samples, &report).front();
  CHECK(report.missing == 2);
  CHECK(report.left_out == 1);
  CHECK(report.warnings.size() == 2);
  for (Index t = 0; t < kSize * kSize; ++t) {
    const bool is_missing = t == nan || t == left_out;
    for (int c = 0; c < 3; ++c)
      REQUIRE(result.texel(t)[c] == (is_missing ? filtered : image).texel(t)[c]);
  }
}

TEST_CASE("black under a mask was never lit and does not count", "[masks]") {
  Image image = make_image(kSize, kSize, 3), mask = make_image(kSize, kSize, 1);
  for (Index t = 0; t < kSize * kSize; ++t) {
    const bool hidden = t % kSize < 12;
    mask.pixels[t] = hidden ? 0.F : 1.F;
    std::fill_n(image.texel(t), 3, hidden ? 0.F : 0.7F);
  }
  FilterOptions options = some_options();
  options.kind = FilterKind::gaussian;
  FilterReport report;
  const Image result = run(image, options, &mask, nullptr, &report).front();
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0],
             Catch::StartsWith("576 texels that the mask leaves out are black"));
  for (Index t = 0; t < kSize * kSize; ++t)
    REQUIRE(result.texel(t)[0] == Approx(mask.pixels[t] * 0.7).margin(1e-6));
  // A mask of samples that says that they count: then they do.
  Image all = mask;
  std::fill(all.pixels.begin(), all.pixels.end(), 1.F);
  CHECK(run(image, options, &mask, &all).front().texel(13)[0] < 0.6F);
}

TEST_CASE("detail that was taken away is added again, in codes", "[masks]") {
  const Image image = rgba();
  FilterOptions options = some_options();
  const auto with_gain = [&](double gain, const char* space) {
    options.detail_gain = gain;
    SurfaceTextures textures = one_texture(image, options);
    textures.tiles[0].space = find_colour_space(space);
    return filter(make_plane(1, 1), textures, options).front();
  };
  const char* const space = GENERATE("raw", "sRGB");
  const Image plain = with_gain(0, space), more = with_gain(0.5, space);
  const Image restored = with_gain(1, space);
  for (Index t = 0; t < kSize * kSize; ++t) {
    for (int c = 0; c < 4; ++c) {
      const float in = image.texel(t)[c], out = plain.texel(t)[c];
      REQUIRE(more.texel(t)[c] == Approx(out + 0.5 * (in - out)).margin(2e-6));
      REQUIRE(restored.texel(t)[c] == Approx(in).margin(2e-6));
    }
  }
}

TEST_CASE("alpha spreads with the weights of the filter", "[masks]") {
  // An opaque half beside a clear one.
  Image image = make_image(kSize, kSize, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < kSize * kSize; ++t) {
    const bool leaf = t % kSize < kSize / 2;
    const float texel[] = {leaf ? 0.8F : 0, 0.6F, 0.2F, leaf ? 1.F : 0};
    std::copy_n(texel, 4, image.texel(t));
  }
  FilterOptions options = some_options();
  options.kind = FilterKind::gaussian;
  options.filter_alpha = true;
  options.method = GENERATE(FilterMethod::direct, FilterMethod::nodes);
  const Image result = run(image, options, nullptr, nullptr).front();
  const Index row = 24 * kSize, half = kSize / 2;
  for (Index x = 0; x < kSize; ++x) {
    const float alpha = result.texel(row + x)[3];
    const double expected = 0.5 * std::erfc((double(x) + 0.5 - half) / (2 * std::sqrt(2.0)));
    CHECK(alpha == Approx(expected).margin(0.01));
    REQUIRE(result.texel(row + x)[0] == Approx(x < half ? 0.8 : 0).margin(1e-4));
  }
  Image opaque = make_image(8, 8, 3);
  CHECK_THROWS_WITH(run(opaque, options, nullptr, nullptr),
                    Catch::Contains("there is no alpha: the texture has 3 channels"));
}

TEST_CASE("where alpha alone changes straight codes stay, those multiplied with it do not",
          "[masks]") {
  // One colour, so that none changes; alpha does.
  Image image = make_image(kSize, kSize, 4);
  image.alpha_channel = 3;
  for (Index t = 0; t < kSize * kSize; ++t) {
    const float texel[] = {0.3F, 0.6F, 0.9F, t % kSize < kSize / 2 ? 1.F : 0.5F};
    std::copy_n(texel, 4, image.texel(t));
  }
  Image premultiplied = image;
  for (Index t = 0; t < kSize * kSize; ++t)
    for (int c = 0; c < 3; ++c) premultiplied.texel(t)[c] *= premultiplied.texel(t)[3];
  FilterOptions options = some_options();
  options.filter_alpha = true;
  const auto filtered = [&](const Image& of, bool is_premultiplied) {
    SurfaceTextures textures = one_texture(of, options);
    textures.tiles[0].premultiplied = is_premultiplied;
    textures.tiles[0].space = find_colour_space("sRGB");
    return filter(make_plane(1, 1), textures, options).front();
  };
  const Image a = filtered(image, false), b = filtered(premultiplied, true);
  for (Index t = 0; t < kSize * kSize; ++t) {
    for (int c = 0; c < 3; ++c) {
      REQUIRE(a.texel(t)[c] == Approx(image.texel(t)[c]).margin(1e-6));
      REQUIRE(b.texel(t)[c] == Approx(image.texel(t)[c] * b.texel(t)[3]).margin(1e-5));
    }
  }
}

TEST_CASE("a chart without any value stays as it is, and so does its gutter", "[masks]") {
  // Two squares apart in the atlas and in space; the mask leaves one out.
  TriangleMesh mesh = make_plane(1, 1);
  for (const Vec3& p : std::vector<Vec3>(mesh.positions))
    mesh.positions.push_back(p + Vec3(9, 0, 0));
  for (Vec2& uv : mesh.uvs) uv = Vec2(0.05 + 0.4 * uv.x(), 0.05 + 0.9 * uv.y());
  for (const Vec2& uv : std::vector<Vec2>(mesh.uvs)) mesh.uvs.push_back(uv + Vec2(0.5, 0));
  for (const auto f : std::vector<std::array<Index, 3>>(mesh.faces))
    mesh.faces.push_back({f[0] + 4, f[1] + 4, f[2] + 4});
  for (const auto f : std::vector<std::array<Index, 3>>(mesh.face_uvs))
    mesh.face_uvs.push_back({f[0] + 4, f[1] + 4, f[2] + 4});
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  const Image image = make_texture(kSize, kSize, Pattern::checker, 0.3, 5, 3);
  Image mask = make_image(kSize, kSize, 1);
  for (Index t = 0; t < kSize * kSize; ++t) mask.pixels[t] = t % kSize < kSize / 2 ? 1.F : 0.F;
  FilterOptions options = some_options();
  options.gutter = 3;
  if (GENERATE(false, true)) options.despike = 1.5;
  SurfaceTextures textures = one_texture(image, options);
  textures.tiles[0].sample_mask = &mask;
  textures.tiles[0].space = find_colour_space("sRGB");
  const std::vector<Image> result = filter(mesh, textures, options);
  bool changed = false;
  for (Index t = 0; t < kSize * kSize; ++t) {
    for (int c = 0; c < 3; ++c) {
      const float before = image.texel(t)[c], after = result[0].texel(t)[c];
      CHECK(std::isfinite(after));
      if (t % kSize >= kSize / 2) CHECK(before == after);
      changed |= before != after;
    }
  }
  CHECK(changed);
}

TEST_CASE("a surface whose texels are all left out is refused", "[masks]") {
  const Image image = make_texture(16, 16, Pattern::checker, 0.2, 3, 3);
  const Image nothing = make_image(16, 16, 1);
  CHECK_THROWS_WITH(run(image, some_options(), nullptr, &nothing),
                    Catch::Contains("no texel on the surface has a value"));
}

}  // namespace onmesh
