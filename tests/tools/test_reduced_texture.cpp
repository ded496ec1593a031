#include "viewer/server/reduced_texture.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace onmesh;
using namespace onmesh::tools;

namespace {

Image image_of(int width, int height, int channels, std::vector<float> pixels) {
  Image image = make_image(width, height, channels);
  image.pixels = std::move(pixels);
  return image;
}

}  // namespace

TEST_CASE("an even texture stays even once it is reduced") {
  const auto srgb = find_colour_space("sRGB");
  const Image image = image_of(7, 5, 1, std::vector<float>(35, 0.3F));
  for (const int factor : {1, 2, 3}) {
    const Image small = reduced_texture(image, srgb.get(), false, {}, factor);
    CHECK(small.width == (7 + factor - 1) / factor);
    for (const float value : small.pixels) CHECK(value == Approx(0.3F).margin(1e-5));
  }
}

TEST_CASE("means are of light") {
  const auto srgb = find_colour_space("sRGB");
  const Image image = image_of(2, 2, 1, {0, 1, 1, 0});
  CHECK(reduced_texture(image, nullptr, false, {}, 2).pixels[0] == Approx(0.5F));
  CHECK(reduced_texture(image, srgb.get(), false, {}, 2).pixels[0] == Approx(0.7354F).margin(1e-3));
}

TEST_CASE("padding does not get in, unless there is nothing else") {
  const Image image = image_of(4, 2, 1, {0, 1, 0, 1, 0, 1, 0, 1});
  const Image small = reduced_texture(image, nullptr, false, {0, 1, 0, 0, 0, 1, 0, 0}, 2);
  CHECK(small.pixels == std::vector<float>{1, 0.5F});
}

TEST_CASE("alpha weighs colours, and what is not finite is left out") {
  Image image = image_of(2, 1, 2, {0.2F, 1, 0.8F, 0});
  image.alpha_channel = 1;
  const Image weighed = reduced_texture(image, nullptr, false, {}, 2);
  CHECK(weighed.pixels[0] == Approx(0.2F));
  CHECK(weighed.pixels[1] == Approx(0.5F));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  CHECK(reduced_texture(image_of(2, 1, 1, {kNan, 0.5F}), nullptr, false, {}, 2).pixels[0] == 0.5F);
}

TEST_CASE("textures of up to 512 texels are not reduced") {
  CHECK(reduction_of(make_image(512, 512, 1)) == 1);
  CHECK(reduction_of(make_image(513, 2, 1)) == 2);
  CHECK(reduction_of(make_image(4, 4096, 1)) == 8);
}
