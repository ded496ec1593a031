#include "onmesh/kernel/cost_model.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace onmesh;

namespace {

/// A million texels of 1 x 1, nodes `spacing` apart.
WorkSize square(double spacing) {
  return {1e6, 1e6 / (spacing * spacing * std::sqrt(0.75)), 1e6, 1e6};
}

}  // namespace

TEST_CASE("subnodes are half an edge apart, a quarter where patches are halved", "[cost_model]") {
  CHECK(subnode_spacing(square(10), {8, 20, 0.1}) == Approx(5).epsilon(1e-3));
  CHECK(subnode_spacing(square(10), {4, 10, 0.1}) == Approx(2.5).epsilon(1e-3));
}

TEST_CASE("direct sums cost in proportion to the pairs", "[cost_model]") {
  const double cost = cost_of_sums(square(10), {8, 20, 0.1});
  CHECK(cost_of_sums(square(10), {16, 40, 0.1}) == Approx(4 * cost));
  WorkSize twice = square(10);  // twice the resolution along both sides
  twice.samples *= 4;
  twice.targets *= 4;
  CHECK(cost_of_sums(twice, {8, 20, 0.1}) == Approx(16 * cost));
  // No more pairs than all of them.
  CHECK(cost_of_sums(square(10), {1e4, 2e4, 0.1}) == Approx(0.6e12));
}

TEST_CASE("the cost of nodes does not depend on sigma if they are spaced by it", "[cost_model]") {
  const double narrow = cost_of_nodes(square(8), {8, 20, 0.1}, 3);
  CHECK(cost_of_nodes(square(32), {32, 80, 0.1}, 3) < narrow);
  CHECK(cost_of_nodes(square(32), {32, 80, 0.1}, 3) > narrow / 2);
  // Planes and colours cost.
  CHECK(cost_of_nodes(square(8), {8, 20, 0.1}, 1) < narrow);
  CHECK(cost_of_nodes(square(8), {8, 20, 0}, 3) < narrow);
  // What they are there for.
  CHECK(narrow < cost_of_sums(square(8), {8, 20, 0.1}));
  CHECK(cost_of_nodes(square(2), {2, 5, 0.1}, 3) > cost_of_sums(square(2), {2, 5, 0.1}));
}
