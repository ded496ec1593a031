#include "onmesh/kernel/splat/face_parts.h"

#include <catch2/catch.hpp>

#include "onmesh/kernel/splat/halved_patch.h"
#include "support/flat_patch.h"

using namespace onmesh;

namespace {

/// Where a part's corner is, in barycentric coordinates of the patch's face.
std::array<float, 3> corner_of(const FacePart& part, int corner) {
  std::array<float, 3> b{};
  for (int i = 0; i < 3; ++i) b[i] = ((i == corner ? 1.0F : 0.0F) - part.offset[i]) / part.scale;
  return b;
}

}  // namespace

TEST_CASE("quarters have their corners at the part's corners and midpoints", "[face_parts]") {
  FacePart part;
  for (const int outer : {-1, 0, 1, 2, 3}) {
    part = outer < 0 ? FacePart() : quarter_of(FacePart(), outer);
    for (int q = 0; q < 4; ++q) {
      const FacePart quarter = quarter_of(part, q);
      for (int k = 0; k < 3; ++k) {
        // The middle one's corners are the midpoints opposite; others keep their own.
        const auto a = corner_of(part, q < 3 ? q : (k + 1) % 3);
        const auto b = corner_of(part, q < 3 ? k : (k + 2) % 3);
        const auto found = corner_of(quarter, k);
        for (int i = 0; i < 3; ++i) CHECK(found[i] == (a[i] + b[i]) / 2);
      }
    }
  }
}

TEST_CASE("a face's parts have the subnodes at their corners", "[face_parts]") {
  const FlatPatch flat = make_flat_patch({.spacing = 8});
  const bool is_halved = GENERATE(false, true);
  HalvedPatch halved;
  halve(flat.patch, flat.table, halved);
  const Patch& patch = is_halved ? halved.patch : flat.patch;
  for (const double longest : {0.0, 100.0}) {
    const Subnodes subnodes = make_subnodes(patch, longest);
    for (Index f = 0; f < flat.patch.faces.size(); f += 5) {
      const SplitFace face = split_face(patch, subnodes, is_halved, f);
      REQUIRE(face.halves == (is_halved ? 4 : 1));
      for (int half = 0; half < face.halves; ++half) {
        const auto& whole = patch.corners[f * Index(face.halves) + Index(half)];
        REQUIRE(face.quarters[half] == (longest == 0 ? 4 : 1));
        if (face.quarters[half] == 1) {
          CHECK(face.corners[4 * half] == whole);
          continue;
        }
        for (int q = 0; q < 4; ++q) {
          for (int k = 0; k < 3; ++k) {
            const auto& ends = subnodes.ends[face.corners[4 * half + q][k]];
            std::array<Index, 2> expected{whole[q < 3 ? q : (k + 1) % 3],
                                          whole[q < 3 ? k : (k + 2) % 3]};
            CHECK(std::minmax(ends[0], ends[1]) == std::minmax(expected[0], expected[1]));
          }
        }
      }
    }
  }
}
