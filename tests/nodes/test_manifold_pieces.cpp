// Properties of the refinement of meshes that are not manifold, piece by piece.
#include "onmesh/nodes/manifold_pieces.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "onmesh/mesh/edge_table.h"
#include "onmesh/procedural/shapes.h"
#include "support/areas.h"
#include "support/random_soup.h"
#include "support/small_meshes.h"

namespace onmesh {
namespace {

/// A cube with a square fin that stands on one of its edges: a slit in a closed surface.
TriangleMesh cube_with_fin() {
  TriangleMesh mesh = make_cube(1);
  const EdgeTable edges(mesh);
  const auto [a, b] = edges.vertices(0);
  const Index c = Index(mesh.positions.size());
  const Vec3 out = mesh.positions[a] + mesh.positions[b];
  mesh.positions.push_back(mesh.positions[a] + out);
  mesh.positions.push_back(mesh.positions[b] + out);
  mesh.faces.push_back({a, b, c + 1});
  mesh.faces.push_back({a, c + 1, c});
  return bare_mesh(mesh.positions, mesh.faces);
}

/// Nodes lie where the overlay puts them, pieces cover every face, sides agree in their lengths.
void check_refinement(const TriangleMesh& mesh, double spacing) {
  RefineOptions options;
  options.spacing = spacing;
  RefineReport report;
  const NodeSurface surface = refine_in_pieces(mesh, options, &report);
  const NodeMesh& nodes = surface.nodes;
  REQUIRE(report.nodes == nodes.nodes.size());
  CHECK_FALSE(report.bisected);
  CHECK(area_of(nodes) == Approx(area_of(mesh)).epsilon(1e-9));
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    CHECK((mesh.position(nodes.nodes[v]) - mesh.positions[v]).norm() < 1e-12);
  }
  int torn = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      const Index across = nodes.neighbours[f][k];
      if (across == kNone) continue;
      torn += nodes.neighbours[across / 3][across % 3] != 3 * f + k;
      torn += nodes.lengths[across / 3][across % 3] != nodes.lengths[f][k];
      const auto ends = std::minmax(nodes.faces[f][k], nodes.faces[f][(k + 1) % 3]);
      torn += ends != std::minmax(nodes.faces[across / 3][across % 3],
                                  nodes.faces[across / 3][(across % 3 + 1) % 3]);
    }
  }
  CHECK(torn == 0);
  // Random points are found where they are: node faces that lie in one input face are flat.
  std::mt19937 random(1);
  double worst = 0;
  int tried = 0;
  for (int i = 0; i < 3000; ++i) {
    Vec3 b(double(random() % 1000), double(random() % 1000), double(random() % 1000 + 1));
    const SurfacePoint point{Index(random() % mesh.faces.size()), b / b.sum()};
    const NodePoint at = surface.overlay.locate(point);
    REQUIRE(at.face != kNone);
    Vec3 position = Vec3::Zero();
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const SurfacePoint& node = nodes.nodes[nodes.faces[at.face][k]];
      inside = inside && node.face == point.face;
      position += at.barycentric[k] * mesh.position(node);
    }
    if (!inside) continue;
    ++tried;
    worst = std::max(worst, (position - mesh.position(point)).norm());
  }
  CHECK(tried > 0);
  CHECK(worst < 1e-9);
}

/// How many faces of the node mesh lie on each pair of nodes, where it is more than two.
std::map<std::pair<Index, Index>, int> branching(const NodeMesh& nodes) {
  std::map<std::pair<Index, Index>, int> count;
  for (const auto& f : nodes.faces) {
    for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax(f[k], f[(k + 1) % 3])];
  }
  std::erase_if(count, [](const auto& entry) { return entry.second < 3; });
  return count;
}

TEST_CASE("pieces keep area, vertices and places, whatever joins them", "[manifold_pieces]") {
  for (const double spacing : {0.3, 0.1}) {
    for (const TriangleMesh& mesh : {make_book(1), make_book(3), make_moebius(1), make_moebius(4),
                                     make_bow_tie(2), make_cube(1), cube_with_fin()}) {
      check_refinement(mesh, spacing);
    }
  }
}

TEST_CASE("along an edge of three faces all have the same nodes", "[manifold_pieces]") {
  for (const TriangleMesh& mesh : {make_book(1), cube_with_fin()}) {
    RefineOptions options;
    options.spacing = 0.1;
    const NodeSurface surface = refine_in_pieces(mesh, options);
    const EdgeTable edges(mesh);
    double length = 0, branching_length = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto [a, b] = edges.vertices(e);
      if (edges.sides(e).size() == 3) length += (mesh.positions[a] - mesh.positions[b]).norm();
    }
    for (const auto& [ends, faces] : branching(surface.nodes)) {
      CHECK(faces == 3);
      branching_length += (mesh.position(surface.nodes.nodes[ends.first]) -
                           mesh.position(surface.nodes.nodes[ends.second]))
                              .norm();
    }
    CHECK(length > 0);
    CHECK(branching_length == Approx(length).epsilon(1e-9));
  }
}

TEST_CASE("random soups are refined in pieces", "[manifold_pieces]") {
  std::mt19937 random(5);
  for (int round = 0; round < 4; ++round) {
    const TriangleMesh mesh = random_soup(30, 0.5, random);
    RefineOptions options;
    options.spacing = 0.1;
    const NodeSurface surface = refine_in_pieces(mesh, options);
    const double area = area_of(mesh);
    CHECK(area_of(surface.nodes) == Approx(area).epsilon(1e-9));
    CHECK(double(surface.nodes.nodes.size()) < 4.5 * area / (0.866 * 0.1 * 0.1));
  }
}

}  // namespace
}  // namespace onmesh
