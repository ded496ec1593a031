#include "onmesh/render/texture_view.h"

#include <catch2/catch.hpp>
#include <limits>

#include "onmesh/base/error.h"
#include "support/pictures.h"

using namespace onmesh;

TEST_CASE("pictures are put beside each other unchanged", "[texture_view]") {
  Image a = make_image(2, 3, 3), b = make_image(4, 2, 3);
  a.pixels[0] = 0.5F;
  b.pixels[0] = 0.25F;
  const Image both = side_by_side({a, b}, 5);
  CHECK(both.width == 2 + 5 + 4);
  CHECK(both.height == 3);
  CHECK(pixel(both, 0, 0)[0] == 0.5);
  CHECK(pixel(both, 7, 0)[0] == 0.25);
  CHECK(pixel(both, 3, 1) == Vec3(1, 1, 1));
  CHECK(pixel(both, 8, 2) == Vec3(1, 1, 1));
}

TEST_CASE("an enlarged texture shows its texels as rectangles", "[texture_view]") {
  Image texture = make_image(3, 2, 1);
  for (std::size_t i = 0; i < 6; ++i) texture.pixels[i] = float(i) / 8;
  const Image picture = view_texture(texture, 30);
  CHECK(picture.width == 30);
  CHECK(picture.height == 20);
  CHECK(picture.channels == 3);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) {
      const double value = ((y / 10) * 3 + x / 10) / 8.0;
      CHECK(pixel(picture, x, y) == Vec3(value, value, value));
    }
  }
}

TEST_CASE("a reduced texture shows means of its texels", "[texture_view]") {
  Image texture = make_image(8, 4, 4);
  for (Index i = 0; i < 32; ++i) {
    texture.texel(i)[0] = i % 2 == 0 ? 1.0F : 0.0F;
    texture.texel(i)[1] = 0.25F;
    texture.texel(i)[3] = 0.5F;  // alpha does not count
  }
  const Image picture = view_texture(texture, 2, 1);
  CHECK(picture.width == 2);
  CHECK(picture.height == 1);
  for (int x = 0; x < 2; ++x) CHECK(pixel(picture, x, 0) == Vec3(0.5, 0.25, 0));
}

TEST_CASE("texel values that no screen can show are clamped, or magenta", "[texture_view]") {
  Image texture = make_image(3, 1, 3);
  texture.texel(0)[0] = 7;
  texture.texel(1)[1] = -7;
  texture.texel(2)[2] = std::numeric_limits<float>::quiet_NaN();
  const Image picture = view_texture(texture, 3);
  CHECK(pixel(picture, 0, 0) == Vec3(1, 0, 0));
  CHECK(pixel(picture, 1, 0) == Vec3(0, 0, 0));
  CHECK(pixel(picture, 2, 0) == Vec3(1, 0, 1));
}

TEST_CASE("a very long texture still is a pixel high", "[texture_view]") {
  const Image picture = view_texture(make_image(1000, 1, 1), 10);
  CHECK(picture.width == 10);
  CHECK(picture.height == 1);
}

TEST_CASE("pictures of impossible size are refused", "[texture_view]") {
  const Image texture = make_image(2, 2, 3);
  CHECK_THROWS_AS(view_texture(texture, 0), UsageError);
  CHECK_THROWS_AS(view_texture(texture, 16385), UsageError);
  CHECK_THROWS_AS(view_texture(texture, 8, 0), UsageError);
  CHECK_THROWS_AS(view_texture(Image(), 8), InputError);
}
