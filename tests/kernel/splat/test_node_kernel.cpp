#include "onmesh/kernel/splat/node_kernel.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/kernel/direct/direct_kernel.h"
#include "support/flat_patch.h"

using namespace onmesh;

namespace {

/// Smooth colours on a patch whose core is away from its border.
FlatPatch make_smooth_patch(double spacing) {
  FlatPatch flat =
      make_flat_patch({.width = 96, .height = 96, .spacing = spacing, .core = 0.3, .channels = 3});
  for (std::size_t t = 0; t < flat.positions.size(); ++t) {
    const double x = flat.positions[t].x() / 96, y = flat.positions[t].y() / 96;
    flat.colours[3 * t] = float(x);
    flat.colours[3 * t + 1] = float(0.5 + 0.5 * std::sin(7 * x + 3 * y));
    flat.colours[3 * t + 2] = float(y * y);
  }
  return flat;
}

}  // namespace

TEST_CASE("sums on subnodes are close to direct sums", "[node_kernel]") {
  const double spacing = GENERATE(5.0, 14.0);  // split; halved and split
  const double sigma = 6, sigma_range = GENERATE(0.0, 0.3);
  const FlatPatch flat = make_smooth_patch(spacing);
  CHECK(NodeKernel::halves(spacing, sigma) == (spacing > 2 * sigma));
  const KernelOptions options{sigma, 2.5 * sigma, sigma_range};
  NodeKernel kernel(options);
  REQUIRE(kernel.load(flat.input()));
  kernel.choose_palette(64);
  std::vector<float> out, support, direct;
  CHECK(kernel.evaluate(out, support) == (sigma_range > 0 ? 64 : 0));
  filter_patch(flat.input(), options, direct);
  REQUIRE(out.size() == direct.size());
  double worst = 0;
  for (std::size_t k = 0; k < out.size(); ++k)
    worst = std::max(worst, std::abs(double(out[k]) - direct[k]));
  INFO("worst " << worst);
  CHECK(worst < 0.006);
  // Weights sum to the integral of a Gaussian that is narrower by what interpolation blurs:
  // subnodes are a half or a quarter of an edge apart. For colours apart they sum to less.
  const double apart = NodeKernel::halves(spacing, sigma) ? spacing / 4 : spacing / 2;
  const double squared = sigma * sigma - apart * apart / 4;
  const double integral =
      2 * M_PI * squared * (1 - std::exp(-options.radius * options.radius / (2 * squared)));
  for (const float s : support) CHECK(s < 1.03 * integral);
  if (sigma_range == 0) {
    for (const float s : support) CHECK(s == Approx(integral).epsilon(0.03));
  }
}

TEST_CASE("on nodes, features are compared and values behind them averaged", "[node_kernel]") {
  // As features the smooth colours, as values their squares: what light is to codes.
  const FlatPatch smooth = make_smooth_patch(5);
  std::vector<float> texels;
  for (std::size_t k = 0; k < smooth.colours.size(); k += 3) {
    const float* const c = &smooth.colours[k];
    texels.insert(texels.end(), {c[0], c[1], c[2], c[0] * c[0], c[1] * c[1], c[2] * c[2]});
  }
  KernelInput input = smooth.input();
  input.colours = {texels.data(), 3, 3, 6, smooth.width, 3};
  const KernelOptions options{6, 15, 0.3};
  NodeKernel kernel(options);
  REQUIRE(kernel.load(input));
  kernel.choose_palette(64);
  std::vector<float> out, support, direct;
  kernel.evaluate(out, support);
  filter_patch(input, options, direct);
  double worst = 0;
  for (std::size_t k = 0; k < out.size(); ++k)
    worst = std::max(worst, std::abs(double(out[k]) - direct[k]));
  CHECK(worst < 0.006);
  // Squares of means are less than means of squares: values are no features.
  std::vector<float> of_features;
  input.colours = {texels.data(), 3, 3, 6, smooth.width, 0};
  filter_patch(input, options, of_features);
  double more = 0;
  for (std::size_t k = 0; k < out.size(); ++k)
    more = std::max(more, double(direct[k]) - of_features[k] * of_features[k]);
  CHECK(more > 0.02);
}

TEST_CASE("nodes that are too coarse for sigma are refused", "[node_kernel]") {
  const FlatPatch flat = make_flat_patch({.spacing = 10});
  CHECK_FALSE(NodeKernel({0.5, 1.25, 0}).load(flat.input()));
  CHECK(NodeKernel({3, 7.5, 0}).load(flat.input()));
}

TEST_CASE("support counts less where the palette has no colour like the target's",
          "[node_kernel]") {
  // Dark and bright halves, and a grey spot that two colours leave out.
  const double sigma = 6;
  FlatPatch flat = make_flat_patch({.width = 96, .height = 96, .core = 0.5, .channels = 1});
  const auto is_grey = [&](Index t) {
    return (flat.positions[t] - Vec2(48, 48)).cwiseAbs().maxCoeff() < 4;
  };
  for (Index t = 0; t < flat.colours.size(); ++t)
    flat.colours[t] = is_grey(t) ? 0.5F : flat.positions[t].x() < 48 ? 0.0F : 1.0F;
  NodeKernel kernel({sigma, 2.5 * sigma, 0.2});
  REQUIRE(kernel.load(flat.input()));
  std::array<float, 2> most{};
  std::vector<float> out, support;
  for (const int colours : {2, 16}) {
    kernel.choose_palette(colours);
    kernel.evaluate(out, support);
    for (std::size_t k = 0; k < support.size(); ++k)
      if (is_grey(flat.target_texels[k]))
        most[colours == 16] = std::max(most[colours == 16], support[k]);
  }
  CHECK(most[1] > 20);
  CHECK(most[0] < most[1] / 4);
}
