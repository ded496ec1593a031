#include "onmesh/atlas/overlap.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "support/squares_on_one_chart.h"

namespace onmesh {
namespace {

constexpr int kSide = 48;

TEST_CASE("texels that only one place claims leave nothing to decide", "[overlap]") {
  const TexelMap map = make_texel_map(make_plane(1, 1), kSide, kSide);
  for (const Overlap overlap : {Overlap::average, Overlap::first, Overlap::error}) {
    const OverlapPolicy policy(overlap, map);
    CHECK(policy.texels().empty());
    CHECK(policy.warning().empty());
    CHECK_FALSE(policy.first_only());
    CHECK_FALSE(policy.shares());
  }
}

TEST_CASE("each policy tells what becomes of texels that two places claim", "[overlap]") {
  const TexelMap map = make_texel_map(squares_on_one_chart(), kSide, kSide);
  const std::string what =
      "2304 texels are claimed by several places of the surface, the first at column 0, row 0";
  const OverlapPolicy average(Overlap::average, map), first(Overlap::first, map);
  CHECK(average.texels().size() == kSide * kSide);
  CHECK(average.shares());
  CHECK_FALSE(average.first_only());
  CHECK(average.warning() == what + "; they get the mean of the results (overlap=average)");
  CHECK(first.texels() == average.texels());
  CHECK(first.first_only());
  CHECK_FALSE(first.shares());
  CHECK(first.warning() == what + "; they get the first face's result (overlap=first)");
  CHECK_THROWS_WITH(OverlapPolicy(Overlap::error, map), "overlap=error: " + what);
  CHECK_THROWS_AS(OverlapPolicy(Overlap::error, map), InputError);
}

TEST_CASE("the first claims are those of the faces that come first, each texel once", "[overlap]") {
  const TriangleMesh mesh = squares_on_one_chart();
  const TexelMap map = make_texel_map(mesh, kSide, kSide), first = first_claims(map);
  CHECK(first.claims.size() == kSide * kSide);
  CHECK(first.overlapped().empty());
  const std::size_t half = mesh.faces.size() / 2;
  CHECK(first.face_offsets[half] == kSide * kSide);
  CHECK(std::equal(map.face_offsets.begin(), map.face_offsets.begin() + std::ptrdiff_t(half) + 1,
                   first.face_offsets.begin()));
}

}  // namespace
}  // namespace onmesh
