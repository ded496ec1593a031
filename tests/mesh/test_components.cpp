#include "onmesh/mesh/components.h"

#include <catch2/catch.hpp>

#include "support/small_meshes.h"

using namespace onmesh;

TEST_CASE("faces that share a vertex are one component, numbered by first faces", "[components]") {
  const TriangleMesh mesh =
      bare_mesh(std::vector<Vec3>(12, Vec3::Zero()),
                {{9, 10, 11}, {0, 1, 2}, {3, 4, 5}, {2, 6, 7}, {11, 11, 8}, {5, 4, 3}});
  const FaceComponents components = connected_components(mesh);
  CHECK(components.of_face == std::vector<Index>{0, 1, 2, 1, 0, 2});
  CHECK(components.count == 3);
}

TEST_CASE("a mesh without faces has no components", "[components]") {
  CHECK(connected_components(bare_mesh({{0, 0, 0}}, {})).count == 0);
  CHECK(connected_components({}).of_face.empty());
}
