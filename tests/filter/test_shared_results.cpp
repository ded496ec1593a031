#include "onmesh/filter/shared_results.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/texture.h"
#include "support/squares_on_one_chart.h"

namespace onmesh {
namespace {

using Catch::Contains;

constexpr int kSide = 48;

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

TEST_CASE("shared results are merged by area, and only where the policy says so", "[overlap]") {
  const TexelMap map = make_texel_map(squares_on_one_chart(), kSide, kSide);
  const Samples all = samples_of(map), few = samples_of(first_claims(map));
  const auto never = [](Index, const float*) { FAIL("it is shared"); };
  std::vector<float> results;
  for (std::size_t k = 0; k < all.samples.size(); ++k) {
    // 1 on the small square and 6 on the large one, of four times the area: 5 on average.
    const bool is_large = k >= all.samples.size() / 2;
    results.insert(results.end(), {is_large ? 6.0F : 1.0F, float(all.samples[k].texel)});
  }
  Index alone = 0;
  SharedResults unshared(OverlapPolicy(Overlap::first, map), few, 2);
  unshared.store(0, Index(few.samples.size()), results.data(),
                 [&](Index target, const float*) { CHECK(target == alone++); });
  CHECK(alone == few.samples.size());

  SharedResults shared(OverlapPolicy(Overlap::average, map), all, 2);
  // In two parts, as patches come.
  const auto middle = Index(all.samples.size() / 3);
  shared.store(0, middle, results.data(), never);
  shared.store(middle, Index(all.samples.size()), results.data() + std::size_t(middle) * 2, never);
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
  const TriangleMesh both = squares_on_one_chart();
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
