#include "onmesh/image/image.h"

#include <catch2/catch.hpp>

using namespace onmesh;

TEST_CASE("an image in memory is zero, its texels lie row by row", "[image]") {
  Image image = make_image(3, 2, 4);
  CHECK(image.pixels == std::vector<float>(24, 0.0F));
  CHECK(image.source == nullptr);
  image.texel(1 * 3 + 2)[1] = 5;
  CHECK(image.pixels[(1 * 3 + 2) * 4 + 1] == 5);
}

TEST_CASE("all channels but alpha are filtered", "[image]") {
  Image image = make_image(1, 1, 4);
  CHECK(image.range_channels() == std::vector<int>{0, 1, 2, 3});
  image.alpha_channel = 1;
  CHECK(image.range_channels() == std::vector<int>{0, 2, 3});
}
