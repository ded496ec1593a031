// The evaluation on nodes: subnodes, palettes, and the filter against its direct sums.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/filter/filter.h"
#include "onmesh/kernel/splat/palette.h"
#include "onmesh/kernel/splat/subnodes.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/flat_patch.h"

using namespace onmesh;

namespace {

FilterOptions options_for(FilterKind kind, double sigma_texels, FilterMethod method) {
  FilterOptions options;
  options.kind = kind;
  options.sigma_spatial = {sigma_texels, Length::Unit::texel};
  options.sigma_range = 50.0 / 255;
  options.method = method;
  return options;
}

struct Difference {
  double psnr = 0, worst = 0;
};

Difference compare(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double squares = 0;
  Difference result;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double d = std::abs(double(a.pixels[i]) - b.pixels[i]);
    squares += d * d;
    result.worst = std::max(result.worst, d);
  }
  result.psnr = -10 * std::log10(squares / double(a.pixels.size()) + 1e-30);
  return result;
}

/// By nodes against the direct sums.
Difference by_nodes(const TriangleMesh& mesh, const Image& texture, FilterKind kind,
                    double sigma_texels) {
  FilterReport report;
  const Image direct = filter(mesh, texture, options_for(kind, sigma_texels, FilterMethod::direct));
  const Image nodes =
      filter(mesh, texture, options_for(kind, sigma_texels, FilterMethod::nodes), &report);
  CHECK(report.by_nodes > 0.9 * double(report.texels));
  return compare(direct, nodes);
}

}  // namespace

TEST_CASE("subnodes are as far apart as the points that they are", "[nodes]") {
  // On a flat patch every subnode has a place, and distances are straight lines.
  const FlatPatch flat = make_flat_patch(40, 40, 1, 5, 0.5, 1e3, 1, 3);
  const Subnodes subnodes = make_subnodes(flat.patch, 0);
  const double sigma = 6, radius = 15;
  const BlurWeights blur = make_blur(flat.patch, flat.table, subnodes, sigma, radius);
  REQUIRE(blur.offsets.size() == subnodes.core.size() + 1);
  for (std::size_t i = 0; i < subnodes.core.size(); i += 7) {
    std::size_t expected = 0;
    const auto squared = [&](Index a, Index b) {  // by its own formula, over the four ends
      double sum = 0;
      for (const Index m : subnodes.ends[a])
        for (const Index n : subnodes.ends[b]) sum += 0.25 * double(flat.table.row(m)[n]);
      return sum - 0.25 * double(subnodes.squared_length[a]) -
             0.25 * double(subnodes.squared_length[b]);
    };
    const Index own = subnodes.core[i];
    if (subnodes.ends[own][1] >= flat.table.rows) continue;
    for (Index j = 0; j < subnodes.size(); ++j)
      expected += squared(own, j) <= radius * radius * (1 + 1e-5);
    CHECK(blur.offsets[i + 1] - blur.offsets[i] == expected);
    for (std::size_t k = blur.offsets[i]; k < blur.offsets[i + 1]; ++k) {
      const Index j = blur.subnodes[k];
      const double v = 0.5 * (double(subnodes.variance[own]) + subnodes.variance[j]);
      const double exponent = -std::max(squared(own, j), 0.0) / (2 * (sigma * sigma - v));
      CHECK(blur.exponents[k] * std::log(2.0) == Approx(exponent).margin(1e-4));
    }
  }
}

TEST_CASE("edges too short to split have no subnode of their own", "[nodes]") {
  const FlatPatch flat = make_flat_patch(40, 40, 1, 5, 0.5, 1e3, 1, 3);
  const Subnodes all = make_subnodes(flat.patch, 0), none = make_subnodes(flat.patch, 100);
  const auto real = [](const Subnodes& s) {
    return std::size_t(std::count(s.is_real.begin(), s.is_real.end(), 1));
  };
  CHECK(real(all) == all.size());
  CHECK(real(none) == flat.patch.nodes.size());
  CHECK(none.core.size() == flat.patch.core_nodes);
  // The mean barycentric variance of a quarter is a quarter of the face's.
  for (Index n = 0; n < flat.patch.nodes.size(); ++n)
    CHECK(all.variance[n] == Approx(none.variance[n] / 4));
}

TEST_CASE("the palette's range kernel is right where its colours are", "[nodes]") {
  std::mt19937_64 random(5);
  const auto uniform = [&random] { return float(double(random() >> 11) * 0x1p-53); };
  std::vector<float> colours(3 * 900);
  for (float& c : colours) c = 2 * uniform();
  const auto kernel = [](const float* a, const float* b) {
    double squared = 0;
    for (int c = 0; c < 3; ++c) squared += std::pow(double(a[c]) - b[c], 2);
    return std::exp2(-squared);
  };
  double last = 1;
  for (const std::size_t size : {16, 32, 64}) {
    const Palette p = make_palette(colours.data(), 900, 3, 3, size);
    REQUIRE(p.size == size);
    double squares = 0;
    int count = 0;
    for (std::size_t i = 0; i < 900; i += 30) {
      for (std::size_t j = 7; j < 900; j += 30, ++count) {
        double value = 0;
        for (std::size_t k = 0; k < size; ++k) {
          for (std::size_t l = 0; l < size; ++l) {
            std::array<float, 3> ck, cl;
            for (std::size_t c = 0; c < 3; ++c) {
              ck[c] = p.colours[c * p.padded + k];
              cl[c] = p.colours[c * p.padded + l];
            }
            value += kernel(&colours[3 * i], ck.data()) * double(p.inverse[k * p.padded + l]) *
                     kernel(&colours[3 * j], cl.data());
          }
        }
        squares += std::pow(value - kernel(&colours[3 * i], &colours[3 * j]), 2);
      }
    }
    const double rms = std::sqrt(squares / count);
    CHECK(rms < last / 1.5);
    last = rms;
  }
  CHECK(last < 0.01);
}

TEST_CASE("a palette has no more colours than there are", "[nodes]") {
  std::vector<float> colours;
  for (int i = 0; i < 300; ++i) colours.push_back(float(i % 3));
  const Palette p = make_palette(colours.data(), 300, 1, 1, 16);
  CHECK(p.size == 3);
  CHECK(p.residual == Approx(0).margin(1e-9));
}

TEST_CASE("by nodes the Gaussian filter is close to its direct sums", "[nodes][filter]") {
  const Image texture = make_texture(256, 256, Pattern::checker, 0.2, 1);
  for (const double sigma : {6.0, 12.0}) {
    INFO("sigma " << sigma);
    CHECK(by_nodes(make_sphere(4), texture, FilterKind::gaussian, sigma).psnr > 55);
    CHECK(by_nodes(make_torus(48, 20), texture, FilterKind::gaussian, sigma).psnr > 55);
    CHECK(by_nodes(make_cube(), texture, FilterKind::gaussian, sigma).psnr > 50);
  }
}

TEST_CASE("by nodes the bilateral filter is close to its direct sums", "[nodes][filter]") {
  const Image texture = make_texture(256, 256, Pattern::checker, 0.2, 1);
  for (const double sigma : {6.0, 12.0}) {
    for (const TriangleMesh& mesh : {make_sphere(4), make_blob(4, 3), make_cube()}) {
      const Difference difference = by_nodes(mesh, texture, FilterKind::bilateral, sigma);
      INFO("sigma " << sigma << ", " << mesh.faces.size() << " faces");
      CHECK(difference.psnr > 45);
      CHECK(difference.worst < 0.1);
    }
  }
}

TEST_CASE("by nodes any number of channels works", "[nodes][filter]") {
  const int channels = GENERATE(1, 2, 3, 6);
  const Image texture = make_texture(128, 128, Pattern::checker, 0.2, 1, channels);
  const FilterKind kind = GENERATE(FilterKind::bilateral, FilterKind::gaussian);
  CHECK(by_nodes(make_sphere(3), texture, kind, 8).psnr > 45);
}

TEST_CASE("by nodes a constant texture stays, and values that are not finite", "[nodes][filter]") {
  Image texture = make_texture(128, 128, Pattern::checker, 0, 1);
  std::fill(texture.pixels.begin(), texture.pixels.end(), 0.3F);
  for (const FilterKind kind : {FilterKind::bilateral, FilterKind::gaussian}) {
    const FilterOptions options = options_for(kind, 8, FilterMethod::nodes);
    CHECK(filter(make_cube(), texture, options).pixels == texture.pixels);
    Image holed = texture;
    holed.texel(64 * 128 + 64)[0] = std::numeric_limits<float>::quiet_NaN();
    const Image filtered = filter(make_cube(), holed, options);
    for (std::size_t i = 0; i < filtered.pixels.size(); ++i) {
      if (std::isnan(holed.pixels[i])) {
        CHECK(std::isnan(filtered.pixels[i]));
      } else {
        CHECK(filtered.pixels[i] == texture.pixels[i]);
      }
    }
  }
}

TEST_CASE("nodes are given up where the tolerance is not met", "[nodes][filter]") {
  // Noise in three channels, a narrow range: more colours than any palette.
  const Image texture = make_texture(512, 512, Pattern::noise, 0.5, 1);
  FilterOptions options = options_for(FilterKind::bilateral, 16, FilterMethod::automatic);
  options.sigma_range = 0.05;
  options.tolerance = 1e-6;
  FilterReport report;
  const Image automatic = filter(make_plane(4, 4), texture, options, &report);
  CHECK(report.method == "direct");
  options.method = FilterMethod::direct;
  CHECK(compare(automatic, filter(make_plane(4, 4), texture, options)).psnr > 120);
}

TEST_CASE("auto takes the nodes for wide filters of large textures only", "[nodes][filter]") {
  const Image large = make_texture(512, 512, Pattern::checker, 0.2, 1);
  FilterReport report;
  filter(make_plane(4, 4), large, options_for(FilterKind::bilateral, 24, FilterMethod::automatic),
         &report);
  CHECK(report.by_nodes > 0.9 * double(report.texels));
  CHECK(report.checked > 100);
  CHECK(report.rms_error <= 1.0 / 512);
  filter(make_plane(4, 4), large, options_for(FilterKind::bilateral, 3, FilterMethod::automatic),
         &report);
  CHECK(report.method == "direct");
}

TEST_CASE("by nodes the taps per texel are estimated as the direct sums have them",
          "[nodes][filter]") {
  const TriangleMesh mesh = make_sphere(3);
  const Image texture = make_texture(512, 512, Pattern::checker, 0.2, 1);
  FilterReport direct, nodes;
  filter(mesh, texture, options_for(FilterKind::bilateral, 6, FilterMethod::direct), &direct);
  filter(mesh, texture, options_for(FilterKind::bilateral, 6, FilterMethod::nodes), &nodes);
  REQUIRE(nodes.by_nodes > 0.9 * double(nodes.texels));
  CHECK(direct.taps == Approx(double(direct.pairs) / double(direct.texels)));
  CHECK(nodes.pairs < direct.pairs / 4);
  CHECK(nodes.taps == Approx(direct.taps).epsilon(0.03));
}

TEST_CASE("by nodes any number of threads gives the same bytes", "[nodes][filter]") {
  const Image texture = make_texture(256, 256, Pattern::checker, 0.2, 1);
  FilterOptions options = options_for(FilterKind::bilateral, 8, FilterMethod::nodes);
  options.threads = 1;
  const Image one = filter(make_cube(), texture, options);
  for (const int threads : {2, 7}) {
    options.threads = threads;
    CHECK(filter(make_cube(), texture, options).pixels == one.pixels);
  }
}
