#include "onmesh/filter/filter.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/kernel/radius.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/closed_forms.h"
#include "support/filter_error.h"
#include "support/recut_atlas.h"

namespace onmesh {
namespace {

FilterOptions options_for(FilterKind kind, double sigma_texels) {
  FilterOptions options;
  options.kind = kind;
  options.sigma_spatial = {sigma_texels, Length::Unit::texel};
  options.sigma_range = 0.2;
  return options;
}

bool same_values(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

double decibels(double squares, std::size_t count) {
  return 10 * std::log10(double(count) / std::max(squares, 1e-300));
}

/// Over the texels that the mesh covers.
double psnr(const TriangleMesh& mesh, const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  const TexelMap map = make_texel_map(mesh, a.width, a.height);
  double squares = 0;
  std::size_t count = 0;
  for (Index t = 0; t < map.coverage.size(); ++t) {
    if (map.coverage[t] != Coverage::covered) continue;
    for (int c = 0; c < a.channels; ++c, ++count) {
      squares += std::pow(double(a.texel(t)[c]) - b.texel(t)[c], 2);
    }
  }
  REQUIRE(count > 0);
  return decibels(squares, count);
}

Image noise_image(int width, int height, int channels = 3) {
  return make_texture(width, height, Pattern::checker, 0.3, 7, channels);
}

TEST_CASE("a constant texture stays constant", "[filter]") {
  FilterOptions options = options_for(GENERATE(FilterKind::bilateral, FilterKind::gaussian), 3);
  options.samples = GENERATE(SampleKind::texel, SampleKind::poisson);
  Image texture = make_image(96, 72, 3);
  for (std::size_t k = 0; k < texture.pixels.size(); ++k) {
    texture.pixels[k] = k % 3 == 0 ? 0.3F : k % 3 == 1 ? 0.7F : 0.1F;
  }
  CHECK(same_values(filter(make_cube(), texture, options), texture));
}

TEST_CASE("the result stays within the texture's range", "[filter]") {
  const TriangleMesh mesh = make_sphere(2);
  const Image texture = noise_image(128, 128);
  const Image result = filter(mesh, texture, options_for(FilterKind::bilateral, 3));
  for (int c = 0; c < 3; ++c) {
    float low = 2, high = -2;
    for (Index t = 0; t < 128 * 128; ++t) {
      low = std::min(low, texture.texel(t)[c]);
      high = std::max(high, texture.texel(t)[c]);
    }
    bool within = true;
    for (Index t = 0; t < 128 * 128; ++t) {
      within = within && result.texel(t)[c] >= low && result.texel(t)[c] <= high;
    }
    CHECK(within);
  }
  CHECK_FALSE(same_values(result, texture));
}

TEST_CASE("any number of threads gives the same bytes", "[filter]") {
  const TriangleMesh mesh = make_torus(24, 12);
  const Image texture = noise_image(256, 192);
  FilterOptions options = options_for(FilterKind::bilateral, 3);
  options.samples = GENERATE(SampleKind::texel, SampleKind::poisson);
  if (options.samples == SampleKind::poisson) options.spacing = Length{1.5, Length::Unit::texel};
  options.threads = 1;
  FilterReport report;
  const Image one = filter(mesh, texture, options, &report);
  CHECK(report.patches > 7);
  for (const int threads : {2, 7}) {
    options.threads = threads;
    CHECK(same_values(filter(mesh, texture, options), one));
  }
}

TEST_CASE("a plane filters like the plain 2D filter", "[filter][slow]") {
  const FilterKind kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  const double sigma_texels = GENERATE(1.0, 3.0, 6.5);
  const TriangleMesh mesh = make_plane(3, 2, 1.5, 1);
  const Image texture = noise_image(120, 80);
  const FilterOptions options = options_for(kind, sigma_texels);
  const double db = error_of_filter(mesh, texture, options, 1000, straight_distances(mesh)).psnr;
  CAPTURE(db);
  CHECK(db > 90);
}

TEST_CASE("a stretched plane filters like the 2D filter with stretched distances", "[filter]") {
  const FilterKind kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  const TriangleMesh mesh = make_plane(2, 2, 3, 1);
  const Image texture = noise_image(90, 90);
  const FilterOptions options = options_for(kind, 4);
  const double db = error_of_filter(mesh, texture, options, 1000, straight_distances(mesh)).psnr;
  CAPTURE(db);
  CHECK(db > 90);
}

TEST_CASE("a folded sheet filters like the flat one", "[filter]") {
  // Folded until its leaves nearly touch: 4 degrees between them.
  const double angle = GENERATE(90.0, 4.0);
  const TriangleMesh flat = make_plane(4, 1, 1.6, 1);
  const TriangleMesh folded = make_folded_sheet(4, 1.6, 1, angle);
  const Image texture = noise_image(128, 80);
  const FilterOptions options = options_for(FilterKind::bilateral, 4);
  const double db = psnr(flat, filter(flat, texture, options), filter(folded, texture, options));
  CAPTURE(db);
  CHECK(db > 90);
}

TEST_CASE("an atlas cut into pieces, moved and turned filters like the uncut one", "[filter]") {
  const TriangleMesh mesh = make_plane(8, 6, 4, 3);
  const Image texture = noise_image(128, 96);
  const RecutAtlas recut = recut_atlas(mesh, texture, 5);
  REQUIRE(recut.charts > 4);
  const FilterOptions options = options_for(FilterKind::bilateral, 4);
  const Image whole = filter(mesh, texture, options);
  const Image pieces = filter(recut.mesh, recut.image, options);
  double squares = 0;
  std::size_t count = 0;
  for (Index t = 0; t < recut.new_texel.size(); ++t) {
    if (recut.new_texel[t] == kNone) continue;
    for (int c = 0; c < 3; ++c, ++count) {
      squares += std::pow(double(whole.texel(t)[c]) - pieces.texel(recut.new_texel[t])[c], 2);
    }
  }
  CHECK(decibels(squares, count) > 90);
}

TEST_CASE("moving, turning and scaling mesh and sigma together changes nothing", "[filter]") {
  const TriangleMesh mesh = make_cube();
  TriangleMesh moved = mesh;
  const double scale = 1e-3;
  Eigen::Matrix3d turn;
  turn << 0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6;
  for (Vec3& p : moved.positions) p = scale * (turn * p) + Vec3(5e-3, -2e-3, 1e-2);
  const Image texture = noise_image(96, 72);
  FilterOptions options = options_for(FilterKind::bilateral, 1);
  options.sigma_spatial = {0.3, Length::Unit::mesh};
  const Image before = filter(mesh, texture, options);
  options.sigma_spatial.value *= scale;
  const double db = psnr(mesh, filter(moved, texture, options), before);
  CAPTURE(db);
  CHECK(db > 80);
}

TEST_CASE("texels that no chart needs stay bit for bit, and so does alpha", "[filter]") {
  const TriangleMesh mesh = make_cube();
  Image texture = noise_image(96, 72, 4);
  texture.alpha_channel = GENERATE(3, 0, 1);
  FilterOptions options = options_for(FilterKind::bilateral, 3);
  options.gutter = GENERATE(0, 2);
  FilterReport report;
  const Image result = filter(mesh, texture, options, &report);

  const TexelMap map = make_texel_map(mesh, 96, 72);
  std::size_t alpha_changes = 0, changes = 0, filtered = 0, covered = 0;
  for (Index t = 0; t < map.coverage.size(); ++t) {
    const bool same = std::memcmp(texture.texel(t), result.texel(t), 4 * sizeof(float)) == 0;
    alpha_changes +=
        texture.texel(t)[texture.alpha_channel] != result.texel(t)[texture.alpha_channel];
    const bool is_covered = map.coverage[t] == Coverage::covered;
    covered += is_covered && texture.texel(t)[texture.alpha_channel] > 0;
    filtered += !same && is_covered;
    changes += !same && !is_covered;
  }
  CHECK(alpha_changes == 0);
  CHECK(filtered > 0.99 * double(covered));
  CHECK(report.gutter >= covered / 10 * std::size_t(options.gutter));
  CHECK(changes == report.gutter);
}

TEST_CASE("where alpha is among the channels does not matter to the others", "[filter]") {
  const TriangleMesh mesh = make_cube();
  Image last = noise_image(96, 72, 4);
  last.alpha_channel = 3;
  Image first = last;
  first.alpha_channel = 0;
  for (Index t = 0; t < 96 * 72; ++t) {
    for (int c = 0; c < 4; ++c) first.texel(t)[(c + 1) % 4] = last.texel(t)[c];
  }
  const FilterOptions options = options_for(FilterKind::bilateral, 3);
  const Image a = filter(mesh, last, options), b = filter(mesh, first, options);
  std::size_t different = 0;
  for (Index t = 0; t < 96 * 72; ++t) {
    for (int c = 0; c < 4; ++c) different += a.texel(t)[c] != b.texel(t)[(c + 1) % 4];
  }
  CHECK(different == 0);
}

TEST_CASE("values that are not finite are filled and spread nowhere", "[filter]") {
  const TriangleMesh mesh = make_plane(1, 1);
  Image texture = noise_image(64, 64);
  const Image whole = texture;
  texture.texel(64 * 30 + 30)[1] = std::numeric_limits<float>::quiet_NaN();
  texture.texel(64 * 10 + 40)[0] = std::numeric_limits<float>::infinity();
  const FilterOptions options =
      options_for(GENERATE(FilterKind::bilateral, FilterKind::gaussian), 4);
  FilterReport report;
  const Image result = filter(mesh, texture, options, &report);
  for (const float v : result.pixels) {
    REQUIRE(v >= 0);
    REQUIRE(v <= 1);
  }
  CHECK(report.missing == 2);
  // Out of reach of both nothing changes.
  const Image expected = filter(mesh, whole, options);
  CHECK(result.texel(64 * 60 + 8)[1] == Approx(expected.texel(64 * 60 + 8)[1]).epsilon(1e-5));
}

TEST_CASE("Poisson quadrature comes close to texel quadrature", "[filter][slow]") {
  const TriangleMesh mesh = make_cube();
  SurfaceTextureOptions pattern;
  pattern.noise = 0.1;
  const Image texture = make_surface_texture(mesh, 256, 192, pattern);
  FilterOptions options = options_for(FilterKind::bilateral, 6);
  const Image texels = filter(mesh, texture, options);
  options.samples = SampleKind::poisson;
  FilterReport report;
  const Image poisson = filter(mesh, texture, options, &report);
  CHECK(report.samples > report.texels);
  CHECK(report.without_sample == 0);
  const double db = psnr(mesh, texels, poisson);
  CAPTURE(db);
  CHECK(db > 79);  // samples share the area of the texel that they are in
  CHECK(report.sample_spacing <= report.largest_sample_spacing);
}

TEST_CASE("texels without a Poisson sample within the radius keep their values", "[filter]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image texture = noise_image(64, 64);
  FilterOptions options = options_for(FilterKind::gaussian, 1);
  options.samples = SampleKind::poisson;
  options.spacing = Length{12, Length::Unit::texel};
  options.radius = Length{2, Length::Unit::texel};
  FilterReport report;
  const Image result = filter(mesh, texture, options, &report);
  std::size_t kept = 0;
  for (Index t = 0; t < 64 * 64; ++t) {
    kept += std::memcmp(texture.texel(t), result.texel(t), 3 * sizeof(float)) == 0;
  }
  CHECK(report.without_sample > 1000);
  CHECK(kept >= report.without_sample);
}

TEST_CASE("exact distances and the default agree on a fold", "[filter]") {
  const TriangleMesh mesh = make_folded_sheet(2, 1, 1, 60);
  const Image texture = noise_image(32, 32);
  FilterOptions options = options_for(FilterKind::bilateral, 4);
  const Image default_result = filter(mesh, texture, options);
  options.distance = DistanceMethod::exact;
  FilterReport report;
  CHECK(psnr(mesh, filter(mesh, texture, options, &report), default_result) > 90);
  CHECK(report.backend == "exact");
}

TEST_CASE("an exception from the progress callback stops the work", "[filter]") {
  struct Stop {};
  const TriangleMesh mesh = make_cube();
  const Image texture = noise_image(96, 72);
  int calls = 0;
  const Progress progress = [&calls](std::string_view stage, double done) {
    ++calls;
    if (stage == "filter" && done > 0.3) throw Stop{};
  };
  CHECK_THROWS_AS(filter(mesh, texture, options_for(FilterKind::bilateral, 3), nullptr, progress),
                  Stop);
  CHECK(calls > 5);
}

TEST_CASE("patches without a usable texel are filled from those around", "[filter]") {
  const TriangleMesh mesh = make_plane(4, 4);
  Image texture = make_texture(256, 256, Pattern::checker, 0.2, 1);
  for (int y = 0; y < 256; ++y)
    for (Index x = 0; x < 200; ++x)
      texture.texel(Index(y) * 256 + x)[0] = std::numeric_limits<float>::quiet_NaN();
  for (const FilterMethod method : {FilterMethod::direct, FilterMethod::nodes}) {
    FilterOptions options = options_for(FilterKind::bilateral, 4);
    options.method = method;
    options.gutter = 0;
    FilterReport report;
    const Image result = filter(mesh, texture, options, &report);
    double change = 0;
    for (Index t = 0; t < 256 * 256; ++t) {
      REQUIRE(result.texel(t)[0] >= 0);
      REQUIRE(result.texel(t)[0] <= 1);
      if (t % 256 >= 200)
        change = std::max<double>(change, std::abs(result.texel(t)[0] - texture.texel(t)[0]));
    }
    CHECK(change > 0.01);
    CHECK(report.missing == 256 * 200);
    CHECK(report.without_sample > 256 * 150);  // beyond the radius
  }
}

TEST_CASE("without a gutter only texels whose centre is on a chart change", "[filter]") {
  const TriangleMesh mesh = make_blob(2, 1);
  const Image texture = make_texture(128, 128, Pattern::checker, 0.2, 1);
  FilterOptions options = options_for(FilterKind::gaussian, 2);
  options.gutter = 0;
  const Image result = filter(mesh, texture, options);
  const TexelMap map = make_texel_map(weld(mesh), 128, 128);
  std::size_t changed = 0, touched = 0;
  for (Index t = 0; t < 128 * 128; ++t) {
    const bool is_same = std::equal(result.texel(t), result.texel(t) + 3, texture.texel(t));
    changed += is_same ? 0 : 1;
    touched += map.coverage[t] == Coverage::touched ? 1 : 0;
    if (map.coverage[t] != Coverage::covered) REQUIRE(is_same);
  }
  CHECK(changed > 1000);
  CHECK(touched > 100);
}

TEST_CASE("texels without a sample within the radius keep their values", "[filter]") {
  const TriangleMesh mesh = make_plane(4, 4);
  const Image texture = make_texture(128, 128, Pattern::checker, 0.2, 1);
  for (const FilterMethod method : {FilterMethod::direct, FilterMethod::nodes}) {
    FilterOptions options = options_for(FilterKind::bilateral, 2);
    options.method = method;
    options.samples = SampleKind::poisson;
    options.spacing = Length{0.6};
    FilterReport report;
    const Image result = filter(mesh, texture, options, &report);
    CHECK(report.without_sample > 0.9 * double(report.texels));
    std::size_t kept = 0;
    for (Index t = 0; t < 128 * 128; ++t)
      kept += std::memcmp(texture.texel(t), result.texel(t), 3 * sizeof(float)) == 0;
    CHECK(kept >= report.without_sample);
    CHECK(kept < report.texels);
  }
}

TEST_CASE("how far nodes are apart does not decide which texels are within the radius",
          "[filter][slow]") {
  const TriangleMesh mesh = make_plane(4, 4);
  const Image texture = make_texture(500, 500, Pattern::checker, 0.2, 1);
  FilterReport fine, coarse;
  FilterOptions options = options_for(FilterKind::bilateral, 1);
  options.radius = Length{2, Length::Unit::texel};
  options.method = FilterMethod::direct;
  filter(mesh, texture, options, &coarse);
  options.node_spacing = Length{2, Length::Unit::texel};
  filter(mesh, texture, options, &fine);
  CHECK(coarse.nodes < fine.nodes / 4);
  CHECK(coarse.pairs == fine.pairs);
}

}  // namespace
}  // namespace onmesh
