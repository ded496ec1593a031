#include "onmesh/base/random.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace onmesh;

TEST_CASE("the stream is splitmix64", "[random]") {
  // The first outputs for the seed 1234567 of the reference implementation.
  SplitMix random(1234567);
  CHECK(random.next() == 6457827717110365317U);
  CHECK(random.next() == 3203168211198807973U);
  CHECK(random.next() == 9817491932198370423U);
}

TEST_CASE("random numbers of places and of streams are uniform and differ", "[random]") {
  constexpr int kCount = 20000;
  std::set<std::uint64_t> seen;
  double of_places = 0, of_streams = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    seen.insert(random_bits_at(1, i));
    seen.insert(random_bits_at(1, 0, i + 1));
    seen.insert(random_bits_at(1, 0, 0, i + 1));
    const double u = random_unit_at(2, i), v = SplitMix(2, i).uniform();
    CHECK((u >= 0 && u < 1 && v >= 0 && v < 1));
    of_places += u;
    of_streams += v;
  }
  CHECK(seen.size() == 3 * kCount);
  const double error = 4 / std::sqrt(12.0 * kCount);  // four standard deviations
  CHECK(std::abs(of_places / kCount - 0.5) < error);
  CHECK(std::abs(of_streams / kCount - 0.5) < error);
  CHECK(random_bits_at(1, 2, 3, 4) == random_bits_at(1, 2, 3, 4));
}

TEST_CASE("the unit interval is half open", "[random]") {
  CHECK(unit_of_bits(0) == 0);
  CHECK(unit_of_bits(~std::uint64_t{0}) == std::nextafter(1.0, 0.0));
}
