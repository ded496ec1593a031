#include "onmesh/mesh/winding.h"

#include <catch2/catch.hpp>

#include "support/small_meshes.h"

using namespace onmesh;

namespace {

Winding wind(const TriangleMesh& mesh) { return consistent_winding(mesh, EdgeTable(mesh)); }

}  // namespace

TEST_CASE("what is wound consistently stays, and the smaller area turns", "[winding]") {
  TriangleMesh mesh = corner_tetrahedron();
  CHECK(wind(mesh).flip == std::vector<bool>(4, false));
  std::swap(mesh.faces[2][0], mesh.faces[2][1]);  // the largest face
  CHECK(wind(mesh).flip == std::vector<bool>{false, false, true, false});
  for (const std::size_t f : {0, 1}) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
  CHECK(wind(mesh).flip == std::vector<bool>{false, false, false, true});
  CHECK(wind(mesh).conflict == kNone);
}

TEST_CASE("across a branching edge nothing is wound", "[winding]") {
  const TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}},
                                      {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  CHECK(wind(mesh).flip == std::vector<bool>(3, false));
  CHECK(wind(mesh).conflict == kNone);
}

TEST_CASE("a one-sided component is named and stays as it is", "[winding]") {
  // Five vertices: the smallest Moebius strip.
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {});
  for (Index i = 0; i < 5; ++i) add_face(mesh, {i, (i + 1) % 5, (i + 2) % 5});
  const Winding winding = wind(mesh);
  CHECK(winding.conflict != kNone);
  CHECK(winding.flip == std::vector<bool>(5, false));
}
