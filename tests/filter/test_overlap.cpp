#include "onmesh/filter/overlap.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

using Catch::Contains;

constexpr int kSide = 48;

/// Two squares apart from each other, the second twice as large, with the same UVs.
TriangleMesh two_on_one_chart() {
  TriangleMesh mesh = make_plane(1, 1, 1, 1);
  const auto vertices = Index(mesh.positions.size());
  const std::size_t faces = mesh.faces.size();
  for (Index v = 0; v < vertices; ++v) {
    mesh.positions.push_back(2 * mesh.positions[v] + Vec3(0, 0, 10));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const auto corners = mesh.faces[f];
    mesh.faces.push_back({corners[0] + vertices, corners[1] + vertices, corners[2] + vertices});
    mesh.face_uvs.push_back(mesh.face_uvs[f]);
    mesh.face_materials.push_back(mesh.face_materials[f]);
  }
  return mesh;
}

/// Samples for the claims of a map, each of the area that its face's texels have.
Samples samples_of(const TexelMap& map) {
  Samples samples;
  samples.face_offsets = map.face_offsets;
  for (std::size_t f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      samples.samples.push_back(
          {map.tiles[0].texel(map.claims[k]), 0, 0, float(map.texel_area[f])});
    }
  }
  return samples;
}

TEST_CASE("texels that only one place claims leave nothing to decide", "[overlap]") {
  const TexelMap map = make_texel_map(make_plane(1, 1), kSide, kSide);
  for (const Overlap overlap : {Overlap::average, Overlap::first, Overlap::error}) {
    const OverlapPolicy policy(overlap, map, {});
    CHECK(policy.texels().empty());
    CHECK(policy.warning().empty());
    CHECK_FALSE(policy.first_only());
    CHECK_FALSE(policy.shares());
  }
}

TEST_CASE("each policy tells what becomes of texels that two places claim", "[overlap]") {
  const TexelMap map = make_texel_map(two_on_one_chart(), kSide, kSide);
  const std::string what =
      "2304 texels are claimed by several places of the surface, the first at column 0, row 0";
  const OverlapPolicy average(Overlap::average, map, {}), first(Overlap::first, map, {});
  CHECK(average.texels().size() == kSide * kSide);
  CHECK(average.shares());
  CHECK_FALSE(average.first_only());
  CHECK(average.warning() == what + "; they get the mean of the results (overlap=average)");
  CHECK(first.texels() == average.texels());
  CHECK(first.first_only());
  CHECK_FALSE(first.shares());
  CHECK(first.warning() == what + "; they get the first face's result (overlap=first)");
  CHECK_THROWS_WITH(OverlapPolicy(Overlap::error, map, {}), "overlap=error: " + what);
  CHECK_THROWS_AS(OverlapPolicy(Overlap::error, map, {}), InputError);
}

TEST_CASE("the first claims are those of the faces that come first, each texel once", "[overlap]") {
  const TriangleMesh mesh = two_on_one_chart();
  const TexelMap map = make_texel_map(mesh, kSide, kSide), first = first_claims(map);
  CHECK(first.claims.size() == kSide * kSide);
  CHECK(first.overlapped().empty());
  const std::size_t half = mesh.faces.size() / 2;
  CHECK(first.face_offsets[half] == kSide * kSide);
  CHECK(std::equal(map.face_offsets.begin(), map.face_offsets.begin() + std::ptrdiff_t(half) + 1,
                   first.face_offsets.begin()));
}

TEST_CASE("shared results are merged by area, and only where the policy says so", "[overlap]") {
  const TexelMap map = make_texel_map(two_on_one_chart(), kSide, kSide);
  const Samples all = samples_of(map), few = samples_of(first_claims(map));
  CHECK(SharedResults(OverlapPolicy(Overlap::first, map, {}), few, 2).targets().empty());

  SharedResults shared(OverlapPolicy(Overlap::average, map, {}), all, 2);
  REQUIRE(shared.targets().size() == all.samples.size());
  for (std::size_t k = 0; k < all.samples.size(); ++k) {
    // 1 on the small square and 6 on the large one, of four times the area: 5 on average.
    const bool is_large = k >= all.samples.size() / 2;
    const float values[] = {is_large ? 6.0F : 1.0F, float(all.samples[k].texel)};
    shared.keep(k, values);
  }
  Index written = 0;
  shared.merge([&](Index texel, const float* values) {
    CHECK(texel == written++);
    CHECK(values[0] == Approx(5));
    CHECK(values[1] == float(texel));
  });
  CHECK(written == kSide * kSide);
}

/// Largest difference of two images.
double difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double worst = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k)
    worst = std::max(worst, std::abs(double(a.pixels[k]) - b.pixels[k]));
  return worst;
}

TEST_CASE("the filter follows each policy", "[overlap][filter]") {
  const TriangleMesh both = two_on_one_chart();
  const std::size_t half = both.faces.size() / 2;
  std::vector<bool> first(both.faces.size(), false), second(both.faces.size(), false);
  std::fill(first.begin(), first.begin() + std::ptrdiff_t(half), true);
  std::fill(second.begin() + std::ptrdiff_t(half), second.end(), true);

  const Image texture = make_texture(kSide, kSide, Pattern::checker, 0.3, 7, 3);
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = {0.06, Length::Unit::mesh};
  options.node_spacing = Length{0.08, Length::Unit::mesh};
  options.faces = first;
  const Image small = filter(both, texture, options);
  options.faces = second;
  const Image large = filter(both, texture, options);
  REQUIRE(difference(small, large) > 0.01);

  options.faces.clear();
  FilterReport report;
  const Image average = filter(both, texture, options, &report);
  CHECK(report.overlapped == kSide * kSide);
  CHECK(report.texels == 2 * kSide * kSide);
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("(overlap=average)"));
  Image expected = texture;
  for (std::size_t k = 0; k < expected.pixels.size(); ++k) {
    expected.pixels[k] = (small.pixels[k] + 4 * large.pixels[k]) / 5;
  }
  CHECK(difference(average, expected) < 1e-5);

  options.overlap = Overlap::first;
  CHECK(difference(filter(both, texture, options, &report), small) < 1e-5);
  CHECK(report.texels == kSide * kSide);
  CHECK_THAT(report.warnings[0], Contains("(overlap=first)"));
  options.overlap = Overlap::error;
  CHECK_THROWS_AS(filter(both, texture, options), InputError);
  CHECK_THROWS_WITH(plan_filter(both, texture, options), Contains("overlap=error: 2304 texels"));
}

}  // namespace
}  // namespace onmesh
