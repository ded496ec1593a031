#include "onmesh/nodes/cut_edges.h"

#include <catch2/catch.hpp>

namespace onmesh {

TEST_CASE("the halves of a cut edge keep the sides that lie on each other together",
          "[cut_edges]") {
  // Two sides run along the edge, the third against them. A half is named by its tail.
  CutEdges cuts;
  CHECK(cuts.empty());
  CHECK(cuts.sides(3).empty());
  cuts.add({{1, true}, {2, true}, {9, false}});
  for (const Index tail : {1U, 2U, 9U}) CHECK(cuts.sides(tail).size() == 3);
  cuts.split(2, {11, 12, 13});
  CHECK(cuts.edges().size() == 2);
  const auto tails = [&](Index tail) {
    std::vector<Index> result;
    for (const CutEdges::Side& side : cuts.sides(tail)) result.push_back(side.tail);
    return result;
  };
  // At the forward sides' start the third one has its far half.
  CHECK(tails(1) == std::vector<Index>{1, 2, 13});
  CHECK(tails(13) == tails(1));
  CHECK(tails(9) == std::vector<Index>{11, 12, 9});
  CHECK(tails(12) == tails(9));
  CHECK(cuts.middles() == std::vector<std::vector<Index>>{{11, 12, 13}});
  CHECK(cuts.sides(5).empty());
}

}  // namespace onmesh
