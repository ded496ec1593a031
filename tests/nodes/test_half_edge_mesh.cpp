#include "onmesh/nodes/half_edge_mesh.h"

#include <catch2/catch.hpp>
#include <random>

#include "onmesh/base/error.h"
#include "support/small_meshes.h"

using namespace onmesh;
using Catch::Matchers::Contains;
using Face = std::array<Index, 3>;

TEST_CASE("the half-edge mesh has the triangle mesh's numbers, in whatever order faces come",
          "[half_edge_mesh]") {
  constexpr Index n = 12;
  std::vector<Vec3> positions;
  std::vector<Face> faces;
  for (Index i = 0; i < n * n; ++i) positions.emplace_back(i % n, i / n, 0.5 * i);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {  // a torus with a hole
      if (i == 3 && j == 4) continue;
      const Index a = j * n + i, b = j * n + (i + 1) % n, c = (j + 1) % n * n + (i + 1) % n,
                  d = (j + 1) % n * n + i;
      faces.push_back({a, b, c});
      faces.push_back({a, c, d});
    }
  }
  std::mt19937 random(5);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(faces.begin(), faces.end(), random);
    const HalfEdgeMesh mesh = make_half_edge_mesh(bare_mesh(positions, faces));
    REQUIRE(mesh.n_vertices() == positions.size());
    REQUIRE(mesh.n_faces() == faces.size());
    CHECK(mesh.n_edges() == 3 * n * n - 1);
    for (const auto v : mesh.vertices()) {
      const auto p = mesh.point(v);
      CHECK(Vec3(p[0], p[1], p[2]) == positions[static_cast<std::size_t>(v.idx())]);
    }
    for (const auto f : mesh.faces()) {
      std::vector<Index> corners;
      for (const auto v : f.vertices_ccw()) corners.push_back(static_cast<Index>(v.idx()));
      const auto& expected = faces[static_cast<std::size_t>(f.idx())];
      REQUIRE(corners.size() == 3);
      std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), expected[0]),
                  corners.end());
      CHECK(std::equal(corners.begin(), corners.end(), expected.begin()));
    }
  }
}

TEST_CASE("what is not manifold is refused with number, place and remedy", "[half_edge_mesh]") {
  const auto error_of = [](const TriangleMesh& mesh) -> std::string {
    try {
      make_half_edge_mesh(mesh);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::vector<Vec3> p = {{0, 0, 0},  {1, 0, 0},   {0, 1, 0},
                               {0, -1, 0}, {0, 0, 2.5}, {0, 0, -1}};
  CHECK(error_of(bare_mesh(p, {{0, 1, 2}, {1, 0, 3}})) == "no error");
  CHECK(error_of(bare_mesh(p, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})) ==
        "the mesh is not manifold: 1 edge has three or more faces, between (0, 0, 0) and (1, 0, "
        "0); split or remove the "
        "extra faces");
  CHECK_THAT(
      error_of(bare_mesh(p, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 1, 3}, {1, 2, 5}})),
      Contains("2 edges have three or more faces, the first one between (0, 0, 0) and (1, 0, 0)"));
  CHECK_THAT(error_of(bare_mesh(p, {{0, 1, 2}, {4, 3, 5}, {4, 1, 0}})),
             Contains("1 vertex joins parts") && Contains("at (0, 0, 2.5)"));
  CHECK_THAT(error_of(bare_mesh(p, {{0, 1, 2}, {0, 1, 3}})),
             Contains("not wound consistently") && Contains("between (0, 0, 0) and (1, 0, 0)"));
  CHECK_THAT(error_of(bare_mesh(p, {{0, 1, 1}})), Contains("face 0") && Contains("twice"));
}
