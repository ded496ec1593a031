#include "onmesh/kernel/direct/target_order.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "support/flat_patch.h"

using namespace onmesh;

TEST_CASE("every target that is wanted is listed once, with its face", "[target_order]") {
  const FlatPatch flat = make_flat_patch({.width = 70, .height = 50, .core = 0.8});
  const std::vector<Index> slots = first_slots(flat.input());
  std::vector<unsigned char> is_wanted(slots.back(), 1);
  const bool all = GENERATE(true, false);
  for (Index slot = 0; slot < is_wanted.size() && !all; slot += 3) is_wanted[slot] = 0;
  const std::vector<TargetPlace> places = order_targets(flat.input(), slots, is_wanted);
  std::vector<unsigned char> is_listed(slots.back(), 0);
  for (const TargetPlace& place : places) {
    REQUIRE(place.face < flat.patch.core_faces);
    CHECK(slots[place.face] <= place.slot);
    CHECK(place.slot < slots[place.face + 1]);
    CHECK(is_listed[place.slot] == 0);
    is_listed[place.slot] = 1;
  }
  CHECK(is_listed == is_wanted);
}

TEST_CASE("full squares of texels come first, each in one piece", "[target_order]") {
  constexpr Index kSide = 4;  // 16 texels
  const Index width = 64;
  const FlatPatch flat = make_flat_patch({.width = int(width), .height = 48, .core = 0.7});
  const std::vector<Index> slots = first_slots(flat.input());
  const auto square_of = [&](Index slot) {
    const Index texel = flat.target_texels[slot];
    return texel % width / kSide + texel / width / kSide * (width / kSide);
  };
  std::vector<Index> count(width * 48 / (kSide * kSide), 0);
  for (Index slot = 0; slot < slots.back(); ++slot) ++count[square_of(slot)];
  const auto full = std::size_t(std::count(count.begin(), count.end(), kSide * kSide));
  REQUIRE(full > 30);
  const std::vector<TargetPlace> places =
      order_targets(flat.input(), slots, std::vector<unsigned char>(slots.back(), 1));
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Index square = square_of(places[k].slot);
    if (k < full * kSide * kSide) {
      CHECK(count[square] == kSide * kSide);
      CHECK(square == square_of(places[k - k % (kSide * kSide)].slot));
    } else {
      CHECK(count[square] < kSide * kSide);
    }
  }
}
