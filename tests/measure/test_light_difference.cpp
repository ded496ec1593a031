#include "onmesh/measure/light_difference.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace onmesh {
namespace {

Image grey(float value, int channels = 3) {
  Image image = make_image(4, 4, channels);
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

}  // namespace

TEST_CASE("errors in light are those of their formulas", "[light_difference]") {
  const Image a = grey(3), b = grey(2);
  const LightDifference d = light_difference(a, b, nullptr, nullptr, {});
  CHECK(d.colour.rel_mse == Approx(1 / (4 + 0.01)));
  CHECK(d.colour.log_psnr == Approx(-20 * std::log10(std::log(4.0 / 3))));
  CHECK(d.colour.values == 48);
  CHECK_FALSE(d.alpha);
  const LightDifference same = light_difference(a, a, nullptr, nullptr, {});
  CHECK(same.colour.rel_mse == 0);
  CHECK(std::isinf(same.colour.log_psnr));
}

TEST_CASE("codes are decoded, each image by its own space", "[light_difference]") {
  const auto srgb = find_colour_space("sRGB");
  // The code of half the light.
  const Image code = grey(0.735357F), light = grey(0.5F);
  CHECK(light_difference(code, light, srgb.get(), nullptr, {}).colour.rel_mse < 1e-10);
  CHECK(light_difference(code, light, nullptr, nullptr, {}).colour.rel_mse > 0.1);
}

TEST_CASE("alpha is apart, and what is left out or not finite does not count",
          "[light_difference]") {
  Image a = grey(1, 4), b = grey(1, 4);
  a.alpha_channel = b.alpha_channel = 3;
  for (Index t = 0; t < 16; ++t) b.texel(t)[3] = 0.5F;
  a.texel(2)[0] = b.texel(2)[0] = std::numeric_limits<float>::quiet_NaN();
  b.texel(5)[1] = 7;
  std::vector<unsigned char> counted(16, 1);
  counted[5] = 0;
  const LightDifference d = light_difference(a, b, nullptr, nullptr, counted);
  CHECK(d.colour.rel_mse == 0);
  CHECK(d.colour.values == 44);
  REQUIRE(d.alpha);
  CHECK(d.alpha->rel_mse == Approx(0.25 / 0.26));
  CHECK(d.alpha->values == 15);
}

TEST_CASE("errors of several pairs are those of all values together", "[light_difference]") {
  const LightDifference one = light_difference(grey(3), grey(2), nullptr, nullptr, {});
  const LightDifference none = light_difference(grey(2), grey(2), nullptr, nullptr, {});
  const LightDifference both = together(std::vector<LightDifference>{one, none, none, none});
  CHECK(both.colour.rel_mse == Approx(one.colour.rel_mse / 4));
  CHECK(both.colour.log_psnr == Approx(one.colour.log_psnr + 20 * std::log10(2.0)));
}

}  // namespace onmesh
