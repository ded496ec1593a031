#include "onmesh/kernel/splat/subnodes.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "support/flat_patch.h"

using namespace onmesh;

TEST_CASE("edges too short to split have no subnode of their own", "[subnodes]") {
  const FlatPatch flat = make_flat_patch({});
  const Subnodes all = make_subnodes(flat.patch, 0), none = make_subnodes(flat.patch, 100);
  const auto real = [](const Subnodes& s) {
    return std::size_t(std::count(s.is_real.begin(), s.is_real.end(), 1));
  };
  CHECK(real(all) == all.size());
  CHECK(real(none) == flat.patch.nodes.size());
  CHECK(none.core.size() == flat.patch.core_nodes);
  // The mean barycentric variance of a quarter is a quarter of the face's.
  for (Index n = 0; n < flat.patch.nodes.size(); ++n)
    CHECK(all.variance[n] == Approx(none.variance[n] / 4));
}
