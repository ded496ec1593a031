#include "onmesh/mesh/vertex_fans.h"

#include <catch2/catch.hpp>

#include "support/small_meshes.h"

using namespace onmesh;

TEST_CASE("faces at a vertex that no edge joins there are fans apart", "[vertex_fans]") {
  // A fan of two faces and a single one, all at vertex 0.
  const TriangleMesh mesh =
      bare_mesh(std::vector<Vec3>(7, Vec3::Zero()), {{0, 1, 2}, {0, 2, 3}, {4, 0, 5}, {6, 6, 0}});
  DisjointSets fans = join_fans(mesh, EdgeTable(mesh));
  CHECK(fans.find(3 * 1 + 0) == 3 * 0 + 0);
  CHECK(fans.find(3 * 2 + 1) == 3 * 2 + 1);
  // The collapsed face has no fan.
  CHECK(count_fans(mesh, fans) == std::vector<Index>{2, 1, 1, 1, 1, 1, 0});
}

TEST_CASE("every vertex of a closed surface has one fan", "[vertex_fans]") {
  const TriangleMesh mesh = corner_tetrahedron();
  DisjointSets fans = join_fans(mesh, EdgeTable(mesh));
  CHECK(count_fans(mesh, fans) == std::vector<Index>(4, 1));
}
