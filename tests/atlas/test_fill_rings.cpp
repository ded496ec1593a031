#include "onmesh/atlas/fill_rings.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("texels without values are filled from around them, ring by ring", "[fill_rings]") {
  const TexelMap map = make_texel_map(make_plane(1, 1), 16, 16);
  Image image = make_image(16, 16, 2);
  image.alpha_channel = 1;
  for (Index t = 0; t < 256; ++t) {
    const bool inside = t % 16 >= 4 && t % 16 < 12 && t / 16 >= 4 && t / 16 < 12;
    image.texel(t)[0] = inside ? kNan : float(t % 16);
    image.texel(t)[1] = 0.25F;
  }
  CHECK(fill_rings(map, texels_of(image)) == 0);
  for (Index t = 0; t < 256; ++t) {
    REQUIRE(image.texel(t)[0] >= 0);
    REQUIRE(image.texel(t)[0] <= 15);
    REQUIRE(image.texel(t)[1] == 0.25F);
  }
  // Symmetric, and in the first ring the mean of what is beside it.
  CHECK(image.texel(8 * 16 + 4)[0] == 3);
  CHECK(image.texel(8 * 16 + 11)[0] == 12);
  CHECK(image.texel(8 * 16 + 5)[0] + image.texel(8 * 16 + 10)[0] == Approx(15));
}

TEST_CASE("a chart without any value keeps none", "[fill_rings]") {
  TriangleMesh mesh = make_plane(1, 1);
  for (Vec2& uv : mesh.uvs) uv.x() /= 2;
  const TexelMap map = make_texel_map(mesh, 8, 4);
  Image image = make_image(8, 4, 1);
  for (Index t = 0; t < 32; ++t) image.pixels[t] = t % 8 < 4 ? kNan : 1;
  CHECK(fill_rings(map, texels_of(image)) == 16);
  CHECK(std::isnan(image.pixels[0]));
}

}  // namespace onmesh
