#include "onmesh/nodes/refine.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"
#include "support/areas.h"
#include "support/small_meshes.h"

using namespace onmesh;

namespace {

NodeSurface refine_to(const TriangleMesh& mesh, double spacing, RefineReport* report = nullptr) {
  RefineOptions options;
  options.spacing = spacing;
  return refine_manifold(mesh, options, report);
}

}  // namespace

TEST_CASE("refinement keeps the area and the input's vertices", "[refine]") {
  for (const TriangleMesh& mesh :
       {make_cube(1), make_torus(16, 8), make_blob(2, 1), make_cone(270, 9, 1), make_saddle(6),
        make_u_sheet(1, 1, 0.01, 3)}) {
    RefineReport report;
    const NodeSurface surface = refine_to(mesh, 0.1, &report);
    CHECK(area_of(surface.nodes) == Approx(area_of(mesh)).epsilon(1e-11));
    CHECK(report.nodes == surface.nodes.nodes.size());
    for (Index v = 0; v < mesh.positions.size(); ++v) {
      CHECK((mesh.position(surface.nodes.nodes[v]) - mesh.positions[v]).norm() < 1e-14);
    }
  }
}

TEST_CASE("refined faces keep the angle bound and the size bound", "[refine]") {
  for (const double spacing : {0.3, 0.1, 0.04}) {
    for (const TriangleMesh& mesh :
         {make_cube(1), make_torus(9, 5), make_plane(1, 1), make_blob(1, 9)}) {
      RefineReport report;
      const NodeSurface surface = refine_to(mesh, spacing, &report);
      CHECK(report.smallest_angle_degrees >= 25);
      CHECK(surface.nodes.longest_edge() <= 1.5 * spacing);
    }
  }
}

TEST_CASE("refined edges are Delaunay", "[refine]") {
  const NodeSurface surface = refine_to(make_blob(2, 4), 0.15);
  const NodeMesh& m = surface.nodes;
  const auto opposite_angle = [&](Index f, Index k) {
    const double c = m.lengths[f][k], a = m.lengths[f][(k + 1) % 3], b = m.lengths[f][(k + 2) % 3];
    return std::acos((a * a + b * b - c * c) / (2 * a * b));
  };
  for (Index f = 0; f < m.faces.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      const Index other = m.neighbours[f][k];
      REQUIRE(other != kNone);
      REQUIRE(m.lengths[other / 3][other % 3] == m.lengths[f][k]);
      REQUIRE(opposite_angle(f, k) + opposite_angle(other / 3, other % 3) <
              std::numbers::pi + 1e-6);
    }
  }
}

TEST_CASE("nodes are denser around a cone than on the flat", "[refine]") {
  const TriangleMesh mesh = make_cone(270, 12, 1);
  const NodeSurface surface = refine_to(mesh, 0.1);
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  for (Index f = 0; f < surface.nodes.faces.size(); ++f) {
    const auto& corner = surface.nodes.faces[f];
    const double radius = mesh.position(surface.nodes.nodes[corner[0]]).norm();
    const double size = std::sqrt(surface.nodes.face_area(f));
    if (radius < 0.05) {
      near += size;
      ++near_count;
    } else if (radius > 0.5 && radius < 0.9) {
      far += size;
      ++far_count;
    }
  }
  REQUIRE(near_count > 0);
  REQUIRE(far_count > 0);
  CHECK(near / near_count < 0.4 * far / far_count);
}

TEST_CASE("halving the spacing quadruples the nodes of a flat sheet", "[refine]") {
  const TriangleMesh mesh = make_plane(1, 1);
  double before = 0;
  for (const double spacing : {0.08, 0.04, 0.02}) {
    const auto nodes = static_cast<double>(refine_to(mesh, spacing).nodes.nodes.size());
    const double lattice = 2 / (std::sqrt(3.0) * spacing * spacing);
    CHECK(nodes > lattice);
    CHECK(nodes < 1.4 * lattice);
    if (before > 0) CHECK(nodes / before == Approx(4).epsilon(0.25));
    before = nodes;
  }
}

TEST_CASE("needles, caps and pillows are refined without end", "[refine]") {
  for (const double height : {0.3, 1e-3, 1e-5}) {
    const TriangleMesh tetrahedron =
        bare_mesh({{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, height / 3, height}},
                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    const NodeSurface surface = refine_to(tetrahedron, 0.1);
    CHECK(area_of(surface.nodes) == Approx(area_of(tetrahedron)).epsilon(1e-5));
    CHECK(surface.nodes.nodes.size() < 12000);
  }
}

/// A disk of as many faces around a vertex, which is drawn out.
TriangleMesh drawn_out_hub(Index faces, double radius, double height) {
  TriangleMesh mesh = bare_mesh({{0, 0, height}}, {});
  for (Index i = 0; i < faces; ++i) {
    const double angle = 2 * std::numbers::pi * i / faces;
    mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % faces});
  }
  mesh.face_uvs.assign(faces, {kNone, kNone, kNone});
  mesh.face_materials.assign(faces, kNone);
  return mesh;
}

TEST_CASE("a hub drawn out to a spike has as many pieces as faces", "[refine]") {
  // Every node face around the spike would lie over each of the needles.
  const TriangleMesh mesh = drawn_out_hub(1500, 1e-3, 5);
  RefineOptions options;
  options.spacing = 0.01;
  options.enough_nodes = 20000;
  RefineReport report;
  const NodeSurface surface = refine(mesh, {}, options, &report);
  CHECK(report.bisected);
  CHECK(surface.overlay.pieces.size() == surface.nodes.faces.size());
}

TEST_CASE("a flat hub of many faces gets good shapes as far as there are nodes for them",
          "[refine]") {
  const TriangleMesh mesh = drawn_out_hub(2000, 0.4, 0);
  RefineOptions options;
  options.spacing = 0.1;
  options.enough_nodes = 3000;
  RefineReport report;
  refine(mesh, {}, options, &report);
  CHECK_FALSE(report.bisected);
  CHECK(report.nodes < 3000);
}

TEST_CASE("a face without area does not stop the refinement", "[refine]") {
  // Vertex 4 on the diagonal, seen as a corner by one side only: a flat face closes the gap.
  const TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                                      {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}});
  const NodeSurface surface = refine_to(mesh, 0.2);
  CHECK(area_of(surface.nodes) == Approx(1).epsilon(1e-5));
  for (const auto& l : surface.nodes.lengths) CHECK(l[0] + l[1] + l[2] < 4.5 * 0.2);
}

TEST_CASE("spacings that make no sense are refused", "[refine]") {
  CHECK_THROWS_AS(refine_to(make_plane(1, 1), 0), UsageError);
  CHECK_THROWS_AS(refine_to(make_plane(1, 1), std::nan("")), UsageError);
  RefineOptions options;
  options.spacing = 1e-3;
  options.max_nodes = 1000;
  const TriangleMesh mesh = make_plane(1, 1);
  CHECK_THROWS_AS(refine_manifold(mesh, options), InputError);
}

TEST_CASE("nodes are few where none are needed, and as dense as ever within reach", "[refine]") {
  for (const Index segments : {1U, 16U}) {
    // A large plane with a small needed patch in its corner, in faces of their own.
    TriangleMesh mesh = make_plane(int(segments), int(segments), 10, 10);
    RefineOptions options;
    options.spacing = 0.05;
    options.reach = 0.5;
    options.needed.assign(mesh.faces.size(), false);
    Vec3 corner = Vec3::Zero();
    if (segments == 1) {
      // Both faces touch the needed one, which is cut off at a corner.
      corner = mesh.positions[mesh.faces[0][0]];
      const Index a = Index(mesh.positions.size());
      const auto face = mesh.faces[0];
      mesh.positions.push_back(corner + 0.03 * (mesh.positions[face[1]] - corner));
      mesh.positions.push_back(corner + 0.03 * (mesh.positions[face[2]] - corner));
      const auto other = mesh.faces[1];
      mesh.faces = {{face[0], a, a + 1}, {a, face[1], a + 1}, {face[1], face[2], a + 1}};
      // The other face's side along the diagonal gets the new vertex, too.
      for (Index k = 0; k < 3; ++k) {
        const Index from = other[k], to = other[(k + 1) % 3], apex = other[(k + 2) % 3];
        const bool along = (from == face[2] && to == face[0]) || (from == face[0] && to == face[1]);
        const bool shared = (from == face[2] && to == face[0]) ||
                            (from == face[0] && to == face[2]) ||
                            (from == face[1] && to == face[0]);
        if (!shared && !along) continue;
        const Index split = from == face[2] || to == face[2] ? a + 1 : a;
        mesh.faces.push_back({from, split, apex});
        mesh.faces.push_back({split, to, apex});
      }
      mesh.face_uvs.assign(mesh.faces.size(), {kNone, kNone, kNone});
      mesh.face_materials.assign(mesh.faces.size(), kNone);
      options.needed.assign(mesh.faces.size(), false);
    } else {
      corner = mesh.positions[mesh.faces[0][0]];
    }
    options.needed[0] = true;
    const NodeSurface surface = refine_manifold(mesh, options);
    CHECK(area_of(surface.nodes) == Approx(area_of(mesh)).epsilon(1e-11));
    const double everywhere = 100 * 2 / (std::sqrt(3.0) * 0.05 * 0.05);
    CHECK(double(surface.nodes.nodes.size()) < 0.03 * everywhere);
    double longest = 0;
    for (Index f = 0; f < surface.nodes.faces.size(); ++f) {
      const Index node = surface.nodes.faces[f][0];
      if ((mesh.position(surface.nodes.nodes[node]) - corner).norm() > options.reach) continue;
      for (const double l : surface.nodes.lengths[f]) longest = std::max(longest, l);
    }
    CHECK(longest > 0);
    CHECK(longest <= 1.4 * options.spacing * (1 + 1e-6));
  }
}

TEST_CASE("spikes and strips have no more nodes than are of use", "[refine]") {
  // What is useful grows with the stretch of what the faces carry: a hundredth of their length.
  for (const double height : {1e2, 1e4, 1e6}) {
    TriangleMesh mesh = bare_mesh({{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, height}, {0.25, 0.25, 0}},
                                  {{0, 1, 2}, {1, 3, 2}});
    RefineOptions options;
    options.spacing = 0.1;
    options.least_useful = {height / 100, height / 100};
    for (const bool flat : {false, true}) {
      options.flat_faces = flat;
      CleanReport cleaning;
      const TriangleMesh cleaned = clean(mesh, &cleaning);
      RefineReport report;
      const NodeSurface surface = refine(cleaned, cleaning, options, &report);
      CAPTURE(height, flat, report.nodes);
      CHECK(report.nodes < 6000);
      CHECK(report.nodes > 100);
      // Lengths tell the area of a needle no better than its aspect's square allows.
      if (height <= 1e4 || flat)
        CHECK(area_of(surface.nodes) == Approx(area_of(mesh)).epsilon(1e-6));
    }
  }
}

TEST_CASE("strips and spikes whose faces carry nothing take few nodes", "[refine]") {
  // A spike from a needed square, and a strip far thinner than the spacing.
  TriangleMesh spike = bare_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1e9, 0, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}});
  RefineOptions options;
  options.spacing = 0.1;
  options.reach = 1;
  options.needed = {true, true, false};
  CleanReport cleaning;
  RefineReport report;
  options.enough_nodes = 20000;
  refine(clean(spike, &cleaning), cleaning, options, &report);
  CHECK(report.nodes < 20001);

  const TriangleMesh strip = make_plane(8, 8, 1e9, 1);
  options.spacing = 4000;
  options.needed.clear();
  options.least_useful.assign(strip.faces.size(), 2e6);
  options.enough_nodes = 50000;
  refine(clean(strip, &cleaning), cleaning, options, &report);
  CHECK(report.nodes > 500);  // along the strip
  CHECK(report.nodes <= options.enough_nodes);
}

TEST_CASE("only meshes whose faces must stay flat are bisected", "[refine]") {
  RefineOptions options;
  options.spacing = 0.3;
  for (const TriangleMesh& mesh : {make_cube(), make_book(2), make_bow_tie(1), make_moebius(2)}) {
    CleanReport cleaning;
    const TriangleMesh cleaned = clean(mesh, &cleaning);
    RefineReport report;
    refine(cleaned, cleaning, options, &report);
    CHECK_FALSE(report.bisected);
    options.flat_faces = true;
    refine(cleaned, cleaning, options, &report);
    CHECK(report.bisected);
    options.flat_faces = false;
    CHECK(cleaning.manifold() == (mesh.faces.size() == 12));
    CHECK(cleaning.defects().empty() == cleaning.manifold());
  }
}

TEST_CASE("a bow tie is one node that both halves keep, and nodes are dense there", "[refine]") {
  const TriangleMesh tie = make_bow_tie(4);
  CleanReport cleaning;
  const TriangleMesh cleaned = clean(tie, &cleaning);
  REQUIRE(cleaning.bow_ties == 1);
  RefineOptions options;
  options.spacing = 0.2;
  RefineReport report;
  const NodeSurface surface = refine(cleaned, cleaning, options, &report);
  CHECK_FALSE(report.bisected);
  CHECK(report.nodes == surface.nodes.nodes.size());
  for (const auto& face : surface.nodes.faces) {
    for (const Index n : face) REQUIRE(n < surface.nodes.nodes.size());
  }
  CHECK(area_of(surface.nodes) == Approx(area_of(cleaned)).epsilon(1e-9));
  // All nodes are joined.
  std::vector<Index> reached{0};
  std::vector<bool> seen(surface.nodes.nodes.size(), false);
  seen[0] = true;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (Index k = surface.nodes.node_offsets[reached[i]];
         k < surface.nodes.node_offsets[reached[i] + 1]; ++k) {
      for (const Index n : surface.nodes.faces[surface.nodes.node_faces[k]]) {
        if (!seen[n]) reached.push_back(n);
        seen[n] = true;
      }
    }
  }
  CHECK(reached.size() == surface.nodes.nodes.size());
}
