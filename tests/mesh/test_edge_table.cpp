#include "onmesh/mesh/edge_table.h"

#include <catch2/catch.hpp>
#include <vector>

#include "support/small_meshes.h"

using namespace onmesh;

TEST_CASE("edges come once, in order, with their sides in the order of faces", "[edge_table]") {
  // Two faces across an edge, a third on it that runs the other way, one that has collapsed.
  const TriangleMesh mesh =
      bare_mesh(std::vector<Vec3>(5, Vec3::Zero()), {{0, 1, 2}, {1, 0, 3}, {4, 4, 1}, {0, 1, 4}});
  const EdgeTable edges(mesh);
  std::vector<std::array<Index, 2>> vertices;
  for (std::size_t e = 0; e < edges.size(); ++e) vertices.push_back(edges.vertices(e));
  CHECK(vertices ==
        std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}});
  const auto sides = edges.sides(0);
  REQUIRE(sides.size() == 3);
  CHECK(sides[0].face == 0);
  CHECK(sides[1].face == 1);
  CHECK(sides[2].face == 3);
  CHECK(sides[0].forward);
  CHECK_FALSE(sides[1].forward);
  CHECK(corner_at(mesh, sides[1], 0) == 3 * 1 + 1);
  CHECK(corner_at(mesh, sides[1], 1) == 3 * 1 + 0);
  CHECK_FALSE(edges.inconsistent(0));  // three faces: no pair to compare
}

TEST_CASE("two faces that run along their edge alike are inconsistent", "[edge_table]") {
  const std::vector<Vec3> positions(4, Vec3::Zero());
  CHECK(EdgeTable(bare_mesh(positions, {{0, 1, 2}, {0, 1, 3}})).inconsistent(0));
  CHECK_FALSE(EdgeTable(bare_mesh(positions, {{0, 1, 2}, {1, 0, 3}})).inconsistent(0));
}
