#include "onmesh/patches/edge_extents.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/distance/unfold.h"
#include "onmesh/nodes/refine.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

// Nodes 20 times as far apart in the middle of the sides as at the corners.
NodeMesh graded_cube() {
  const TriangleMesh mesh = make_cube();
  RefineOptions options;
  options.spacing = 0.4;
  options.finest = 0.02;
  return refine_manifold(mesh, options).nodes;
}

}  // namespace

TEST_CASE("extents bound the edges around nodes and hardly change from node to node",
          "[edge_extents]") {
  const NodeMesh nodes = graded_cube();
  const std::vector<double> extents = edge_extents(nodes);
  REQUIRE(extents.size() == nodes.nodes.size());
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const double l = nodes.lengths[f][k];
      const double a = extents[nodes.faces[f][k]], b = extents[nodes.faces[f][(k + 1) % 3]];
      CHECK(a >= l);
      CHECK(std::abs(a - b) <= l / 7 + 1e-5);
    }
  }
}

TEST_CASE("with extents tables have all that pairs within the radius need", "[edge_extents]") {
  const NodeMesh nodes = graded_cube();
  const std::vector<double> extents = edge_extents(nodes);
  std::vector<double> longest(nodes.nodes.size(), 0);  // edge around each node
  for (Index f = 0; f < nodes.faces.size(); ++f)
    for (const Index n : nodes.faces[f])
      for (const double l : nodes.lengths[f]) longest[n] = std::max(longest[n], l);
  const auto backend = make_unfold();
  const double radius = 0.15, edge = nodes.longest_edge(), reach = radius + 2 * edge;
  std::size_t compared = 0, spared = 0;
  for (const auto& core : partition_faces(nodes, std::vector<double>(nodes.faces.size(), 1), 60)) {
    const Patch full = grow_patch(nodes, core, reach + edge);
    const Patch small = grow_patch(nodes, core, radius, extents);
    REQUIRE(small.core_nodes == full.core_nodes);
    DistanceTable all, some;
    backend->fill(full, Reach::up_to(reach), all);
    backend->fill(small, Reach::up_to(radius), some);
    std::vector<Index> in_small(nodes.nodes.size(), kNone);
    for (Index n = 0; n < small.nodes.size(); ++n) in_small[small.nodes[n]] = n;
    for (Index i = 0; i < full.core_nodes; ++i) {
      REQUIRE(small.nodes[i] == full.nodes[i]);
      for (Index j = 0; j < full.nodes.size(); ++j) {
        const Index there = in_small[full.nodes[j]];
        const double most = radius + longest[full.nodes[i]] + longest[full.nodes[j]];
        if (std::sqrt(double(all.row(i)[j])) > most) {
          spared += there == kNone;
          continue;
        }
        REQUIRE(there != kNone);
        REQUIRE(some.row(i)[there] == Approx(all.row(i)[j]).epsilon(2e-5).margin(1e-9));
        ++compared;
      }
    }
  }
  CHECK(compared > 10000);
  CHECK(spared > compared);
}

}  // namespace onmesh
