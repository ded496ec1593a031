#include "onmesh/image/lookup.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace onmesh;

TEST_CASE("bilinear look-ups are exact for linear images and at texel centres", "[lookup]") {
  Image image = make_image(7, 5, 2);
  for (Index i = 0; i < 35; ++i) {
    const double u = (i % 7 + 0.5) / 7, v = 1 - (i / 7 + 0.5) / 5;
    image.texel(i)[0] = float(u + 2 * v);
    image.texel(i)[1] = float(3 - v);
  }
  float out[2];
  for (double u = 0.08; u < 0.92; u += 0.01) {
    for (double v = 0.11; v < 0.89; v += 0.013) {
      bilinear(image, Wrap::repeat, {u, v}, out);
      REQUIRE(std::abs(out[0] - (u + 2 * v)) < 1e-6);
      REQUIRE(std::abs(out[1] - (3 - v)) < 1e-6);
    }
  }
  bilinear(image, Wrap::repeat, {2.5 / 7 - 3, 1.5 / 5 + 9}, out);
  CHECK(out[0] == Approx(2.5 / 7 + 2 * 1.5 / 5));
}

TEST_CASE("look-ups at the border wrap or clamp", "[lookup]") {
  Image image = make_image(4, 1, 1);
  image.pixels = {1, 0, 0, 3};
  float out = 0;
  bilinear(image, Wrap::repeat, {0, 0.5}, &out);
  CHECK(out == Approx(2));
  bilinear(image, Wrap::repeat, {-1000, 0.5}, &out);
  CHECK(out == Approx(2));
  bilinear(image, Wrap::clamp, {0, 0.5}, &out);
  CHECK(out == 1);
  bilinear(image, Wrap::clamp, {1e12, -5}, &out);
  CHECK(out == 3);
  bilinear(image, Wrap::clamp, {-1e12, 5}, &out);
  CHECK(out == 1);
}
