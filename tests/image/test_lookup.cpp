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

TEST_CASE("a mirrored texture is its turned copies side by side, in each direction", "[lookup]") {
  Image image = make_image(3, 2, 1);
  for (Index t = 0; t < 6; ++t) *image.texel(t) = float(t * t);
  for (const WrapModes wrap : {WrapModes(Wrap::mirror), WrapModes(Wrap::mirror, Wrap::clamp),
                               WrapModes(Wrap::repeat, Wrap::mirror)}) {
    // Five periods of each direction written out, the image in the middle.
    const auto source = [](Wrap mode, int i, int n) {
      if (mode == Wrap::clamp) return std::clamp(i, 0, n - 1);
      const int period = i >= 0 ? i / n : -1 - (-1 - i) / n, rest = i - period * n;
      return mode == Wrap::mirror && (period & 1) != 0 ? n - 1 - rest : rest;
    };
    Image large = make_image(15, 10, 1);
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 15; ++x)
        *large.texel(Index(y * 15 + x)) =
            *image.texel(Index(source(wrap.v, y - 4, 2) * 3 + source(wrap.u, x - 6, 3)));
    for (double v = -1.4; v < 2.4; v += 0.093)
      for (double u = -1.4; u < 2.4; u += 0.071) {
        float got = 0, expected = 0;
        bilinear(image, wrap, {u, v}, &got);
        bilinear(large, Wrap::clamp, {(u + 2) / 5, (v + 2) / 5}, &expected);
        REQUIRE(got == Approx(expected).margin(1e-5));
      }
  }
  float far = 0;
  bilinear(image, Wrap::mirror, {1e12 + 1e-4, 0.75}, &far);  // an even period
  CHECK(far == Approx(0).margin(0.01));
  bilinear(image, Wrap::mirror, {-1e12 - 1 + 1e-4, 0.75}, &far);  // an odd one
  CHECK(far == Approx(4).margin(0.01));
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
