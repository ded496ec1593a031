#include "onmesh/base/disjoint_sets.h"

#include <catch2/catch.hpp>
#include <set>
#include <vector>

#include "onmesh/base/random.h"

using namespace onmesh;

TEST_CASE("a set is represented by its lowest member, however it was joined", "[disjoint_sets]") {
  constexpr Index kSize = 60;
  SplitMix random(4);
  for (int joins = 0; joins < 80; joins += 7) {
    DisjointSets sets(kSize);
    std::vector<std::set<Index>> expected(kSize);
    for (Index i = 0; i < kSize; ++i) expected[i] = {i};
    for (int k = 0; k < joins; ++k) {
      const auto a = Index(random.next() % kSize), b = Index(random.next() % kSize);
      sets.join(a, b);
      std::set<Index> both = expected[a];
      both.insert(expected[b].begin(), expected[b].end());
      for (const Index i : both) expected[i] = both;
    }
    for (Index i = 0; i < kSize; ++i) CHECK(sets.find(i) == *expected[i].begin());
  }
}

TEST_CASE("sets are numbered in the order of their first elements", "[disjoint_sets]") {
  const NumberedSets sets = number_sets({7, kNone, 2, 7, 0, 2, kNone});
  CHECK(sets.numbers == std::vector<Index>{0, kNone, 1, 0, 2, 1, kNone});
  CHECK(sets.count == 3);
  CHECK(number_sets({}).count == 0);
  CHECK(number_sets({kNone}).count == 0);
}
