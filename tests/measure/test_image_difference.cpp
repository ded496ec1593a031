#include "onmesh/measure/image_difference.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/base/error.h"
#include "support/atlas_meshes.h"

using namespace onmesh;

namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("equal images differ by nothing", "[image_difference]") {
  Image a = make_image(5, 4, 3);
  a.pixels[7] = kNaN;
  a.pixels[9] = -kInfinity;
  const ImageDifference d = difference(a, a);
  CHECK(d.rms == 0);
  CHECK(d.max == 0);
  CHECK(std::isinf(d.psnr));
  CHECK(d.texels == 20);
}

TEST_CASE("the difference of one texel is found and weighed", "[image_difference]") {
  Image a = make_image(10, 10, 1), b = a;
  b.pixels[37] = -0.5F;
  b.pixels[38] = 0.25F;
  const ImageDifference d = difference(a, b);
  CHECK(d.max == 0.5);
  CHECK(d.worst_texel == 37);
  CHECK(d.rms == Approx(std::sqrt((0.25 + 0.0625) / 100)));
  CHECK(d.psnr == Approx(-20 * std::log10(d.rms)));
}

TEST_CASE("a constant difference of 1/10 is 20 dB whatever the size", "[image_difference]") {
  for (const int size : {1, 13, 300}) {
    const Image a = make_image(size, size, 2);
    Image b = a;
    for (float& v : b.pixels) v = 0.1F;
    CHECK(difference(a, b).psnr == Approx(20));
  }
}

TEST_CASE("only covered texels count when a map is given", "[image_difference]") {
  const TriangleMesh mesh = flat({{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  const TexelMap map = make_texel_map(mesh, 8, 8);
  const Image a = make_image(8, 8, 1);
  Image b = a;
  for (Index y = 0; y < 8; ++y)
    for (Index x = 4; x < 8; ++x) *b.texel(8 * y + x) = y % 2 ? 1 : kNaN;
  const ImageDifference d = difference(a, b, covered_texels(map));
  CHECK(d.max == 0);
  CHECK(d.texels == 32);
  CHECK_THROWS_AS(difference(make_image(4, 4, 1), make_image(4, 4, 1), covered_texels(map)),
                  InputError);
}

TEST_CASE("images that cannot be compared are refused", "[image_difference]") {
  const Image a = make_image(4, 4, 3);
  CHECK_THROWS_AS(difference(a, make_image(4, 5, 3)), InputError);
  CHECK_THROWS_AS(difference(a, make_image(4, 4, 4)), InputError);
  for (const float v : {kNaN, kInfinity, -kInfinity}) {
    Image b = a;
    b.texel(6)[1] = v;
    CHECK_THROWS_WITH(difference(a, b), Catch::Contains("2, 1"));
    CHECK_THROWS_AS(difference(b, a), InputError);
  }
}
