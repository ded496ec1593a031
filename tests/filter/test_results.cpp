#include "onmesh/filter/results.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The values of an image with one colour channel, its first.
Colours colours_of(const Image& image) {
  return {image.pixels.data(), 1, 1, image.channels, image.width};
}

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
  FilterOptions options;
  const SurfaceTextures textures = one_texture(image, options);
  const auto range_of = [&](const Samples* sources) {
    return value_range(WorkingValues(textures, map, options), sources);
  };
  const ValueRange range = range_of(nullptr);
  CHECK(range.lowest == std::vector<float>{0.25F});
  CHECK(range.highest == std::vector<float>{0.75F});
  // What cannot be seen has no colour.
  image.texel(0)[1] = 0;
  CHECK(range_of(nullptr).lowest == std::vector<float>{0.25F});
  image.texel(1)[1] = 0;
  CHECK(range_of(nullptr).lowest == std::vector<float>{0.75F});

  // A sample beside the covered texels counts as well.
  Samples sources;
  sources.samples.push_back({2, 0, 0, 1});
  CHECK(range_of(&sources).highest == std::vector<float>{9});

  // Filtered, alpha has a range as well, and there nothing is left out.
  options.filter_alpha = true;
  CHECK(range_of(nullptr).lowest == std::vector<float>{0.75F, 0});
  CHECK(range_of(nullptr).highest == std::vector<float>{0.75F, 100});
}

TEST_CASE("the robust extent leaves out one hot value in thousands", "[results]") {
  const TexelMap map = make_texel_map(make_plane(1, 1), 100, 100);
  Image image = make_image(100, 100, 2);
  for (Index t = 0; t < 10000; ++t) {
    image.texel(t)[0] = 0.25F + 0.5F * float(t % 100) / 99;
    image.texel(t)[1] = 0.5F;
  }
  const ConstTexelValues texels = texels_of(std::as_const(image));
  CHECK(robust_extent(texels, map) == Approx(0.5));
  image.texel(777)[0] = 60000;
  image.texel(778)[0] = std::numeric_limits<float>::quiet_NaN();
  CHECK(robust_extent(texels, map) == Approx(0.5));
  image.texel(777)[0] = 1e7F;
  CHECK(robust_extent(texels, map) == Approx(10));  // single precision has no more
  image = make_image(100, 100, 1);
  CHECK(robust_extent(texels_of(std::as_const(image)), map) == 1);
}

TEST_CASE("faces with samples far from all others are hot", "[results]") {
  const TexelMap map = make_texel_map(make_plane(1, 1), 100, 100);
  Image image = make_image(100, 100, 1);
  for (Index t = 0; t < 10000; ++t) image.pixels[t] = float(t % 100) / 99;
  Samples sources;
  for (Index t = 0; t < 300; ++t) sources.samples.push_back({t, 0, 0, 1});
  sources.face_offsets = {0, 100, 200, 300};
  CHECK(hot_faces(colours_of(image), map, sources).empty());
  image.pixels[150] = 2.5F;
  CHECK(hot_faces(colours_of(image), map, sources) == std::vector<bool>{false, true, false});
}

TEST_CASE("results are clamped to the range; those that are not finite are not written",
          "[results]") {
  Image image = make_image(4, 2, 2);
  image.alpha_channel = 0;
  for (const Index texel : {0U, 1U, 4U}) image.texel(texel)[0] = 0.5F;
  image.texel(1)[1] = kInfinity;
  image.texel(5)[1] = 0.125F;
  Samples targets;
  for (const Index texel : {0U, 1U, 4U, 2U, 5U}) targets.samples.push_back({texel, 0, 0, 1});
  const Image texture = image;
  const FilterOptions options;
  const SurfaceTextures textures = one_texture(texture, options);
  const TexelMap map = left_half();
  const WorkingValues working(textures, map, options);
  Results results(OverlapPolicy(), targets, working, {{0.25F}, {0.75F}}, texels_of(image));
  const float values[] = {0.5F, 0.6F, 0.8F, kInfinity, 0.6F};
  results.store(0, 5, values);
  results.merge_shared();
  CHECK(image.texel(0)[1] == 0.5F);
  CHECK(image.texel(1)[1] == 0.6F);  // filled
  CHECK(image.texel(4)[1] == 0.75F);
  CHECK(image.texel(2)[1] == 0);
  CHECK(image.texel(5)[1] == 0.125F);  // alpha 0: nothing can be seen of it
  for (const Index texel : {0U, 1U, 4U}) CHECK(image.texel(texel)[0] == 0.5F);
}

}  // namespace
}  // namespace onmesh
