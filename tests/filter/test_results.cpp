#include "onmesh/filter/results.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The left half of a 4 x 2 image.
TexelMap left_half() {
  TriangleMesh mesh = make_plane(1, 1);
  for (Vec2& uv : mesh.uvs) uv.x() /= 2;
  return make_texel_map(mesh, 4, 2);
}

TEST_CASE("the range is that of the covered texels' finite values, per colour channel",
          "[results]") {
  Image image = make_image(4, 2, 2);
  image.alpha_channel = 1;
  const float values[] = {0.5F, 0.25F, 9, 9, kInfinity, 0.75F, 9, 9};
  for (Index t = 0; t < 8; ++t) {
    image.texel(t)[0] = values[t];
    image.texel(t)[1] = 100;
  }
  const TexelMap map = left_half();
  REQUIRE(map.claims.size() == 4);
  const ValueRange range = value_range(texels_of(std::as_const(image)), map, nullptr);
  CHECK(range.lowest == std::vector<float>{0.25F});
  CHECK(range.highest == std::vector<float>{0.75F});
  CHECK(range.extent() == 0.5);

  // A sample beside the covered texels counts as well.
  Samples sources;
  sources.samples.push_back({2, 0, 0, 1});
  CHECK(value_range(texels_of(std::as_const(image)), map, &sources).highest ==
        std::vector<float>{9});
}

TEST_CASE("an image of one colour has range 1", "[results]") {
  const Image image = make_image(4, 2, 3);
  CHECK(value_range(texels_of(std::as_const(image)), left_half(), nullptr).extent() == 1);
}

TEST_CASE("results are clamped to the range and never replace values that are not finite",
          "[results]") {
  Image image = make_image(4, 2, 2);
  image.alpha_channel = 0;
  image.texel(1)[1] = kInfinity;
  Samples targets;
  for (const Index texel : {0U, 1U, 4U}) targets.samples.push_back({texel, 0, 0, 1});
  Results results(OverlapPolicy(), targets, {{0.25F}, {0.75F}}, texels_of(image));
  const float values[] = {0.5F, 0.6F, 0.8F};
  results.store(0, 3, values);
  results.merge_shared();
  CHECK(image.texel(0)[1] == 0.5F);
  CHECK(image.texel(1)[1] == kInfinity);
  CHECK(image.texel(4)[1] == 0.75F);
  for (const Index texel : {0U, 1U, 4U}) CHECK(image.texel(texel)[0] == 0);
}

}  // namespace
}  // namespace onmesh
