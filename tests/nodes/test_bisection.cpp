// Properties of the bisection inside faces.
#include "onmesh/nodes/bisection.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"
#include "support/areas.h"
#include "support/random_soup.h"
#include "support/small_meshes.h"

namespace onmesh {
namespace {

NodeSurface refine_to(const TriangleMesh& mesh, double spacing, RefineReport* report = nullptr) {
  RefineOptions options;
  options.spacing = spacing;
  return refine_by_bisection(mesh, options, report);
}

using Ends = std::pair<Index, Index>;

/// The faces on every pair of corners.
std::map<Ends, int> count_faces(const std::vector<std::array<Index, 3>>& faces) {
  std::map<Ends, int> count;
  for (const auto& f : faces)
    for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax(f[k], f[(k + 1) % 3])];
  return count;
}

/// Conforming over every edge, isometric, and covered by the overlay.
void check_refinement(const TriangleMesh& mesh, const NodeSurface& surface) {
  const NodeMesh& nodes = surface.nodes;
  const auto input_edges = count_faces(mesh.faces), node_edges = count_faces(nodes.faces);
  const auto node_position = [&](Index node) { return mesh.position(nodes.nodes[node]); };
  double worst_area = 0, worst_position = 0, worst_length = 0;
  int torn = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    double covered = 0;
    for (Index p = surface.overlay.face_offsets[f]; p < surface.overlay.face_offsets[f + 1]; ++p) {
      const OverlayPiece& piece = surface.overlay.pieces[p];
      const Eigen::Matrix3d corners = piece.to_node.inverse();
      covered += corners.determinant();
      const auto& face = nodes.faces[piece.node_face];
      for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        const Vec3 at = mesh.position({f, corners.col(k)});
        worst_position = std::max(worst_position, (at - node_position(face[k])).norm());
        const double length = (mesh.position({f, corners.col(l)}) - at).norm();
        worst_length = std::max(worst_length, std::abs(length - nodes.lengths[piece.node_face][k]));
        // An edge of the input face has as many faces on each of its parts, others have two.
        int expected = 2;
        for (int side = 0; side < 3; ++side) {
          if (std::abs(corners(side, k)) > 1e-9 || std::abs(corners(side, l)) > 1e-9) continue;
          const Index a = mesh.faces[f][(side + 1) % 3], b = mesh.faces[f][(side + 2) % 3];
          expected = input_edges.at(std::minmax(a, b));
        }
        torn += node_edges.at(std::minmax(face[k], face[l])) != expected;
        const Index across = nodes.neighbours[piece.node_face][k];
        torn += (across != kNone) != (expected == 2);
        if (across != kNone)
          torn += nodes.neighbours[across / 3][across % 3] != 3 * piece.node_face + Index(k);
      }
    }
    worst_area = std::max(worst_area, std::abs(covered - 1));
  }
  CHECK(torn == 0);
  CHECK(worst_area < 1e-12);
  const double scale = mesh.diagonal();
  CHECK(worst_position < 1e-14 * scale);
  CHECK(worst_length < 1e-14 * scale);
  CHECK(area_of(nodes) == Approx(area_of(mesh)).epsilon(1e-9));
  CHECK(surface.overlay.pieces.size() == nodes.faces.size());
}

TEST_CASE("bisection conforms over any edge, and its pieces cover every face", "[bisection]") {
  for (const double spacing : {0.3, 0.07}) {
    for (const TriangleMesh& mesh : {make_cube(1), make_book(1), make_book(3), make_moebius(1),
                                     make_bow_tie(1), make_blob(1, 3), make_chest(1)}) {
      RefineReport report;
      const NodeSurface surface = refine_to(mesh, spacing, &report);
      check_refinement(mesh, surface);
      CHECK(report.bisected);
      CHECK(report.nodes == surface.nodes.nodes.size());
      CHECK(surface.nodes.longest_edge() <= 1.4 * spacing);
      for (Index v = 0; v < mesh.positions.size(); ++v)
        CHECK((mesh.position(surface.nodes.nodes[v]) - mesh.positions[v]).norm() < 1e-14);
    }
  }
}

TEST_CASE("random soups are refined: thin faces, many faces on an edge", "[bisection]") {
  std::mt19937 random(5);
  for (int round = 0; round < 8; ++round) {
    const TriangleMesh mesh = random_soup(40, 0.2, random);
    check_refinement(mesh, refine_to(mesh, 0.2));
  }
}

TEST_CASE("points of a face are found in the piece that holds them", "[bisection]") {
  const TriangleMesh mesh = make_book(2);
  const NodeSurface surface = refine_to(mesh, 0.1);
  std::mt19937 random(1);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec3 b(double(random() % 1000), double(random() % 1000), double(random() % 1000 + 1));
    const SurfacePoint point{Index(random() % mesh.faces.size()), b / b.sum()};
    const NodePoint at = surface.overlay.locate(point);
    Vec3 position = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Index node = surface.nodes.faces[at.face][k];
      position += at.barycentric[k] * mesh.position(surface.nodes.nodes[node]);
    }
    worst = std::max(worst, (position - mesh.position(point)).norm());
  }
  CHECK(worst < 1e-13);
}

TEST_CASE("slivers of 1:1000 and flat faces come to an end", "[bisection]") {
  for (const double height : {1e-3, 1e-6, 0.0}) {
    const TriangleMesh mesh =
        bare_mesh({{0, 0, 0}, {1, 0, 0}, {0.3, height, 0}, {0.5, -0.4, 0}, {0.5, 0, 0.4}},
                  {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 2, 4}});
    RefineReport report;
    const NodeSurface surface = refine_to(mesh, 0.05, &report);
    check_refinement(mesh, surface);
    CHECK(surface.nodes.longest_edge() <= 1.4 * 0.05);
    CHECK(report.nodes < 550);
  }
}

TEST_CASE("bisection makes about as many nodes as an equilateral lattice", "[bisection]") {
  for (const double spacing : {0.08, 0.04, 0.02}) {
    const auto nodes = double(refine_to(make_plane(1, 1), spacing).nodes.nodes.size());
    const double lattice = 2 / (std::sqrt(3.0) * spacing * spacing);
    // Right triangles of half the square's diagonal, halved until they are small enough: up to
    // twice as many as needed.
    CHECK(nodes > lattice);
    CHECK(nodes < 2 * lattice);
  }
}

/// Mean edge of the faces within a distance of a point.
double mean_edge_near(const TriangleMesh& mesh, const NodeSurface& surface, const Vec3& point,
                      double within) {
  double sum = 0, count = 0;
  for (Index f = 0; f < surface.nodes.faces.size(); ++f) {
    const Index node = surface.nodes.faces[f][0];
    if ((mesh.position(surface.nodes.nodes[node]) - point).norm() > within) continue;
    sum += surface.nodes.lengths[f][0];
    ++count;
  }
  REQUIRE(count > 0);
  return sum / count;
}

TEST_CASE("nodes are dense at cones and bow ties, not along a straight spine", "[bisection]") {
  const TriangleMesh cone = make_cone(200, 12, 1), tie = make_bow_tie(4), book = make_book(4);
  const NodeSurface on_cone = refine_to(cone, 0.1), on_tie = refine_to(tie, 0.1),
                    on_book = refine_to(book, 0.1), page = refine_to(make_plane(4, 4, 1, 1.4), 0.1);
  CHECK(mean_edge_near(cone, on_cone, Vec3::Zero(), 0.05) < 0.05);
  CHECK(mean_edge_near(tie, on_tie, Vec3::Zero(), 0.05) < 0.05);
  CHECK(mean_edge_near(tie, on_tie, Vec3(1, 1, 0), 0.15) > 0.06);
  // Three pages share the nodes of their spine.
  CHECK(on_book.nodes.faces.size() == 3 * page.nodes.faces.size());
}

TEST_CASE("bisection honours max_nodes and refuses senseless spacings", "[bisection]") {
  CHECK_THROWS_AS(refine_to(make_book(1), 0), UsageError);
  CHECK_THROWS_AS(refine_to(make_book(1), std::nan("")), UsageError);
  RefineOptions options;
  options.spacing = 1e-3;
  options.max_nodes = 1000;
  CHECK_THROWS_AS(refine_by_bisection(make_book(1), options), InputError);
}

}  // namespace
}  // namespace onmesh
