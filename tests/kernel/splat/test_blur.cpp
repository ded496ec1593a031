#include "onmesh/kernel/splat/blur.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/kernel/radius.h"
#include "support/flat_patch.h"

using namespace onmesh;

TEST_CASE("subnodes are as far apart as the points that they are", "[blur]") {
  // On a flat patch every subnode has a place, and distances are straight lines.
  const FlatPatch flat = make_flat_patch({});
  const Subnodes subnodes = make_subnodes(flat.patch, 0);
  const double sigma = 6, radius = 15;
  const BlurWeights blur = make_blur(flat.patch, flat.table, subnodes, sigma, radius);
  REQUIRE(blur.offsets.size() == subnodes.core.size() + 1);
  for (std::size_t i = 0; i < subnodes.core.size(); i += 7) {
    std::size_t expected = 0;
    const auto squared = [&](Index a, Index b) {  // by its own formula, over the four ends
      double sum = 0;
      for (const Index m : subnodes.ends[a])
        for (const Index n : subnodes.ends[b]) sum += 0.25 * double(flat.table.row(m)[n]);
      return sum - 0.25 * double(subnodes.squared_length[a]) -
             0.25 * double(subnodes.squared_length[b]);
    };
    const Index own = subnodes.core[i];
    if (subnodes.ends[own][1] >= flat.table.rows) continue;
    for (Index j = 0; j < subnodes.size(); ++j)
      expected += squared(own, j) <= largest_squared(radius);
    CHECK(blur.offsets[i + 1] - blur.offsets[i] == expected);
    for (std::size_t k = blur.offsets[i]; k < blur.offsets[i + 1]; ++k) {
      const Index j = blur.subnodes[k];
      const double v = 0.5 * (double(subnodes.variance[own]) + subnodes.variance[j]);
      const double exponent = -std::max(squared(own, j), 0.0) / (2 * (sigma * sigma - v));
      CHECK(std::log(double(blur.weights[k])) == Approx(exponent).margin(1e-4));
    }
  }
}
