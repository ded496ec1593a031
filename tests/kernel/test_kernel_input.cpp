#include "onmesh/kernel/kernel_input.h"

#include <catch2/catch.hpp>
#include <limits>

#include "onmesh/kernel/radius.h"
#include "support/flat_patch.h"

using namespace onmesh;

TEST_CASE("slots number the targets of the core faces one after the other", "[kernel]") {
  const FlatPatch flat = make_flat_patch({});
  const std::vector<Index> slots = first_slots(flat.input());
  REQUIRE(slots.size() == flat.patch.core_faces + 1);
  CHECK(slots.front() == 0);
  REQUIRE(slots.back() == flat.target_texels.size());
  for (Index f = 0; f < flat.patch.core_faces; ++f) {
    const Index begin = flat.samples.face_offsets[flat.patch.faces[f]];
    for (Index slot = slots[f]; slot < slots[f + 1]; ++slot)
      CHECK(flat.target_texels[slot] == flat.samples.samples[begin + slot - slots[f]].texel);
  }
}

TEST_CASE("texels that are not finite or too large to be squared are not usable", "[kernel]") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, kInfinity, -kInfinity, 1.1e15F, -1.1e15F}) {
    const std::array<float, 3> colour{0.5F, bad, 0.5F};
    CHECK_FALSE(is_usable(colour.data(), 3, 1));
    CHECK(is_usable(colour.data(), 1, 1));
  }
  const std::array<float, 2> large{9e14F, -9e14F};
  CHECK(is_usable(large.data(), 2, 1));
  CHECK_FALSE(is_usable(large.data(), 2, 2));
}

TEST_CASE("the largest distance within the radius is the root of the largest square", "[kernel]") {
  for (const double radius : {1e-6, 0.37, 13.0}) {
    CHECK(largest_squared(radius) > radius * radius);
    CHECK(largest_distance(radius) * largest_distance(radius) ==
          Approx(largest_squared(radius)).epsilon(1e-14));
  }
}
