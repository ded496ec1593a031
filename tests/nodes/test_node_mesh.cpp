#include "onmesh/nodes/node_mesh.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/pages.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

TEST_CASE("a mesh's vertices and faces become nodes and node faces", "[node_mesh]") {
  TriangleMesh mesh = blob(2);
  mesh.positions.emplace_back(9, 9, 9);  // used by no face
  const NodeMesh nodes = make_node_mesh(mesh);
  REQUIRE(nodes.nodes.size() == mesh.positions.size());
  CHECK(nodes.nodes.back().face == kNone);
  double longest = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    CHECK(nodes.face_area(f) == Approx((p[1] - p[0]).cross(p[2] - p[0]).norm() / 2));
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (p[k] - p[(k + 1) % 3]).norm());
      const Index across = nodes.neighbours[f][k];
      REQUIRE(across != kNone);
      CHECK(nodes.neighbours[across / 3][across % 3] == 3 * f + k);
      CHECK(nodes.faces[across / 3][across % 3] == nodes.faces[f][(k + 1) % 3]);
    }
  }
  CHECK(nodes.longest_edge() == Approx(longest));
  for (Index v = 0; v + 1 < nodes.nodes.size(); ++v) {
    const SurfacePoint& at = nodes.nodes[v];
    int corner = 0;
    at.barycentric.maxCoeff(&corner);
    CHECK(mesh.faces[at.face][corner] == v);
    CHECK(std::is_sorted(nodes.node_faces.begin() + nodes.node_offsets[v],
                         nodes.node_faces.begin() + nodes.node_offsets[v + 1]));
  }
}

TEST_CASE("a face that has a node twice is listed once around it", "[node_mesh]") {
  NodeMesh mesh;
  mesh.nodes.resize(2);
  mesh.faces = {{0, 0, 1}, {0, 1, 1}};
  mesh.build_incidence();
  CHECK(mesh.node_offsets == std::vector<Index>{0, 2, 4});
  CHECK(mesh.node_faces == std::vector<Index>{0, 1, 0, 1});
}

TEST_CASE("an edge of three faces glues none of them", "[node_mesh]") {
  const NodeMesh book = make_node_mesh(three_pages(2));
  int loose = 0, glued = 0;
  for (const auto& n : book.neighbours)
    for (const Index across : n) (across == kNone ? loose : glued)++;
  CHECK(loose == 3 * 2 * 3 + 3 * 2);  // three free sides of 2 edges per page, the spine's 2 thrice
  CHECK(glued == 3 * 3 * 8 - loose);  // of 8 faces a page
}

}  // namespace onmesh
