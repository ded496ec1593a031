#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "onmesh/error.h"
#include "onmesh/refine.h"
#include "onmesh/shapes.h"

using namespace onmesh;

namespace {

NodeSurface refine_to(const TriangleMesh& mesh, double spacing, RefineReport* report = nullptr) {
  RefineOptions options;
  options.spacing = spacing;
  return refine(mesh, make_half_edge_mesh(mesh), options, report);
}

double area_of(const NodeMesh& nodes) {
  double sum = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) sum += nodes.face_area(f);
  return sum;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) sum += mesh.face_area(f);
  return sum;
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
  CHECK(near / near_count < 0.6 * far / far_count);
}

TEST_CASE("halving the spacing quadruples the nodes of a flat sheet", "[refine]") {
  const TriangleMesh mesh = make_plane(1, 1);
  double before = 0;
  for (const double spacing : {0.08, 0.04, 0.02}) {
    const auto nodes = static_cast<double>(refine_to(mesh, spacing).nodes.nodes.size());
    const double lattice = 2 / (std::sqrt(3.0) * spacing * spacing);
    CHECK(nodes > 0.7 * lattice);
    CHECK(nodes < 1.7 * lattice);
    if (before > 0) CHECK(nodes / before == Approx(4).epsilon(0.25));
    before = nodes;
  }
}

TEST_CASE("needles, caps and pillows are refined without end", "[refine]") {
  for (const double height : {0.3, 1e-3, 1e-5}) {
    TriangleMesh tetrahedron;
    tetrahedron.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, height, 0),
                             Vec3(0.5, height / 3, height)};
    tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    tetrahedron.face_uvs.assign(4, {kNone, kNone, kNone});
    tetrahedron.face_materials.assign(4, kNone);
    const NodeSurface surface = refine_to(tetrahedron, 0.1);
    CHECK(area_of(surface.nodes) == Approx(area_of(tetrahedron)).epsilon(1e-5));
    CHECK(surface.nodes.nodes.size() < 100000);
  }
}

TEST_CASE("a face without area does not stop the refinement", "[refine]") {
  TriangleMesh mesh = make_plane(1, 1);
  // Vertex 4 on the diagonal, seen as a corner by one side only: a flat face closes the gap.
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0.5, 0.5, 0)};
  mesh.faces = {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}};
  mesh.face_uvs.assign(4, {kNone, kNone, kNone});
  mesh.face_materials.assign(4, kNone);
  const NodeSurface surface = refine_to(mesh, 0.2);
  CHECK(area_of(surface.nodes) == Approx(1).epsilon(1e-5));
  for (const auto& l : surface.nodes.lengths) CHECK(l[0] + l[1] + l[2] < 1e3);
}

TEST_CASE("spacings that make no sense are refused", "[refine]") {
  CHECK_THROWS_AS(refine_to(make_plane(1, 1), 0), UsageError);
  CHECK_THROWS_AS(refine_to(make_plane(1, 1), std::nan("")), UsageError);
  RefineOptions options;
  options.spacing = 1e-3;
  options.max_nodes = 1000;
  const TriangleMesh mesh = make_plane(1, 1);
  CHECK_THROWS_AS(refine(mesh, make_half_edge_mesh(mesh), options), InputError);
}
