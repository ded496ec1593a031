#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/base/error.h"
#include "onmesh/measure/image_difference.h"
#include "support/atlas_meshes.h"

using namespace onmesh;

namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

/// Two triangles that share a mesh edge (the square's diagonal) and have charts of their own: the
/// second's UVs are moved by `offset`.
TriangleMesh cut_square(const Vec2& offset) {
  TriangleMesh mesh =
      flat({{0.1, 0.1}, {0.4, 0.1}, {0.4, 0.4}, {0.1, 0.4}}, {{0, 1, 2}, {0, 2, 3}});
  for (const Index i : {0, 2, 3}) mesh.uvs.push_back(mesh.uvs[i] + offset);
  mesh.face_uvs[1] = {4, 5, 6};
  return mesh;
}

}  // namespace

TEST_CASE("equal images differ by nothing", "[compare]") {
  Image a = make_image(5, 4, 3);
  a.pixels[7] = kNaN;
  a.pixels[9] = -kInfinity;
  const ImageDifference d = difference(a, a);
  CHECK(d.rms == 0);
  CHECK(d.max == 0);
  CHECK(std::isinf(d.psnr));
  CHECK(d.texels == 20);
}

TEST_CASE("the difference of one texel is found and weighed", "[compare]") {
  Image a = make_image(10, 10, 1), b = a;
  b.pixels[37] = -0.5F;
  b.pixels[38] = 0.25F;
  const ImageDifference d = difference(a, b);
  CHECK(d.max == 0.5);
  CHECK(d.worst_texel == 37);
  CHECK(d.rms == Approx(std::sqrt((0.25 + 0.0625) / 100)));
  CHECK(d.psnr == Approx(-20 * std::log10(d.rms)));
}

TEST_CASE("a constant difference of 1/10 is 20 dB whatever the size", "[compare]") {
  for (const int size : {1, 13, 300}) {
    const Image a = make_image(size, size, 2);
    Image b = a;
    for (float& v : b.pixels) v = 0.1F;
    CHECK(difference(a, b).psnr == Approx(20));
  }
}

TEST_CASE("only covered texels count when a map is given", "[compare]") {
  const TriangleMesh mesh = flat({{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  const TexelMap map = make_texel_map(mesh, 8, 8);
  const Image a = make_image(8, 8, 1);
  Image b = a;
  for (Index y = 0; y < 8; ++y)
    for (Index x = 4; x < 8; ++x) *b.texel(8 * y + x) = y % 2 ? 1 : kNaN;
  const ImageDifference d = difference(a, b, &map);
  CHECK(d.max == 0);
  CHECK(d.texels == 32);
  CHECK_THROWS_AS(difference(make_image(4, 4, 1), make_image(4, 4, 1), &map), InputError);
}

TEST_CASE("images that cannot be compared are refused", "[compare]") {
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

TEST_CASE("bilinear look-ups are exact for linear images and at texel centres", "[compare]") {
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

TEST_CASE("look-ups at the border wrap or clamp", "[compare]") {
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

TEST_CASE("a seam of equal pictures has no error, a step its height", "[compare]") {
  const Vec2 offset(0.5, 0.5);
  const TriangleMesh mesh = cut_square(offset);
  const TexelMap map = make_texel_map(mesh, 40, 40);
  Image image = make_image(40, 40, 2);
  for (Index i = 0; i < 1600; ++i) {
    // The picture repeats at the offset of the second chart.
    image.texel(i)[0] = float(std::sin(i % 40 % 20) * std::cos(i / 40 % 20));
    image.texel(i)[1] = 0.25F;
  }
  SeamError error = seam_error(mesh, map, image);
  CHECK(error.edges == 1);
  CHECK(error.length == Approx(0.3 * std::sqrt(2)));
  CHECK(error.max < 1e-6);
  for (Index i = 0; i < 1600; ++i)
    if (i % 40 >= 20) image.texel(i)[1] = 0.75F;
  error = seam_error(mesh, map, image);
  CHECK(error.max == Approx(0.5));
  CHECK(error.rms == Approx(0.5 / std::sqrt(2)));
}

TEST_CASE("an uncut mesh has no seams", "[compare]") {
  const TriangleMesh mesh = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  const TexelMap map = make_texel_map(mesh, 4, 4);
  const SeamError error = seam_error(mesh, map, make_image(4, 4, 1));
  CHECK(error.edges == 0);
  CHECK(error.length == 0);
  CHECK(error.rms == 0);
}
