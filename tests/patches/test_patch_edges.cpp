#include "onmesh/patches/patch_edges.h"

#include <catch2/catch.hpp>
#include <set>

#include "support/distance_errors.h"
#include "support/pages.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

// Edges by Euler's formula are one per two sides and one per side of a border; here by the ends of
// sides, as no two edges have the same.
std::size_t count_by_ends(const Patch& patch) {
  std::set<std::pair<Index, Index>> ends;
  for (const auto& c : patch.corners)
    for (int k = 0; k < 3; ++k) ends.insert(std::minmax(c[k], c[(k + 1) % 3]));
  return ends.size();
}

}  // namespace

TEST_CASE("sides of one edge have one number, with and without gluing", "[patch_edges]") {
  for (const TriangleMesh& mesh : {plane(5, 4, 1, 1), icosphere(1), three_pages(2)}) {
    const Patch glued = whole(make_node_mesh(mesh));
    Patch loose = glued;
    loose.neighbours.clear();
    for (const Patch& patch : {glued, loose}) {
      Index count = 0;
      const auto number = number_edges(patch, count);
      CHECK(count == count_by_ends(patch));
      std::vector<std::pair<Index, Index>> ends(count, {kNone, kNone});
      for (std::size_t f = 0; f < number.size(); ++f)
        for (int k = 0; k < 3; ++k) {
          REQUIRE(number[f][k] < count);
          const auto own = std::minmax(patch.corners[f][k], patch.corners[f][(k + 1) % 3]);
          auto& known = ends[number[f][k]];
          if (known.first == kNone) known = own;
          CHECK(known == std::pair<Index, Index>(own));
        }
    }
  }
}

TEST_CASE("edges between the same two nodes are told apart by their lengths", "[patch_edges]") {
  // Two triangles on the same nodes: two edges differ in length, the third is one edge.
  Patch patch;
  patch.nodes = {0, 1, 2};
  patch.corners = {{0, 1, 2}, {0, 1, 2}};
  patch.lengths = {{1, 1, 1}, {1, 1.2, 1.3}};
  Index count = 0;
  const auto number = number_edges(patch, count);
  CHECK(count == 5);
  CHECK(number[0][0] == number[1][0]);
  CHECK(number[0][1] != number[1][1]);
  CHECK(number[0][2] != number[1][2]);
}

}  // namespace onmesh
