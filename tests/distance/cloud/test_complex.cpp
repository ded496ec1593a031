// The complex that the point-cloud back end builds of the points.
#include "onmesh/distance/cloud/complex.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "onmesh/distance/cloud/tufted_cover.h"
#include "onmesh/procedural/shapes.h"
#include "support/distance_errors.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

cloud::Complex complex_of(const TriangleMesh& mesh) {
  const NodeMesh nodes = make_node_mesh(mesh);
  return cloud::make_complex(whole(nodes), cloud::make_node_geometry(mesh, nodes));
}

double area_of(const Patch& complex, const std::vector<float>& weights = {}) {
  double area = 0;
  for (std::size_t f = 0; f < complex.lengths.size(); ++f) {
    const auto& l = complex.lengths[f];
    area += triangle_area(l[0], l[1], l[2]) * (weights.empty() ? 1.0 : double(weights[f]));
  }
  return area;
}

}  // namespace

TEST_CASE("several sheets at one node are several points", "[cloud]") {
  const TriangleMesh mesh = make_book(4, 40);
  const NodeMesh nodes = make_node_mesh(mesh);
  const cloud::PointCloud points =
      cloud::make_points(whole(nodes), cloud::make_node_geometry(mesh, nodes));
  std::map<Index, int> count;
  for (Index p = 0; p < points.size(); ++p) {
    ++count[points.node[p]];
    const Vec3& at = points.position[p];
    CHECK(points.normal[p].norm() == Approx(1));
    CHECK(points.is_flat[p]);
    // In the plane of its page.
    CHECK(std::abs(points.normal[p].y()) < 1e-12);
    CHECK(std::abs(points.normal[p].dot(at)) < 1e-12);
  }
  for (const auto& [node, several] : count)
    CHECK(several ==
          (std::hypot(mesh.positions[node].x(), mesh.positions[node].z()) < 1e-9 ? 3 : 1));
}

TEST_CASE("points on both sides of a crease see each other over it", "[cloud]") {
  cloud::PointCloud points;
  const double bend = 2.1;  // radians between the planes z = 0, x < 0 and the one that leaves x = 0
  const Vec3 down(std::cos(bend), 0, -std::sin(bend));
  points.position = {Vec3(-0.4, 0, 0), 0.7 * down + Vec3(0, 0.5, 0)};
  points.normal = {Vec3(0, 0, 1), Vec3(std::sin(bend), 0, std::cos(bend))};
  points.is_flat = {1, 1};
  const cloud::Sight there = look(points, 0, 1, 1), back = look(points, 1, 0, 1);
  REQUIRE(there.valid);
  CHECK(there.length == Approx(std::hypot(1.1, 0.5)));
  CHECK((there.offset - Vec3(1.1, 0.5, 0)).norm() < 1e-12);
  CHECK(back.length == Approx(there.length));
  points.normal[1] *= -1;
  CHECK(look(points, 0, 1, -1).length == Approx(there.length));
  points.is_flat[1] = 0;  // a rounded surface: straight
  points.normal[1] = Vec3(0, 0, 1);
  CHECK(look(points, 0, 1, 1).length == Approx((points.position[1] - points.position[0]).norm()));
}

TEST_CASE("the cloud's triangles cover the surface once", "[cloud]") {
  for (const TriangleMesh& mesh :
       {plane(12, 10, 1.2, 1, 0.35), plane(12, 10, 12, 1, 0.3), icosphere(3), make_book(6), cube(4),
        make_folded_sheet(12, 2, 1, 160, 8)}) {
    const cloud::Complex complex = complex_of(mesh);
    double area = 0;
    for (Index f = 0; f < mesh.faces.size(); ++f) area += mesh.face_area(f);
    CHECK(complex.triangles.corners.size() == mesh.faces.size());
    CHECK(area_of(complex.triangles) == Approx(area).epsilon(1e-9));
    CHECK(area_of(complex.cover, complex.weights) == Approx(area).epsilon(1e-9));
  }
}

TEST_CASE("the Laplacian of the tufted cover is positive and sees linear functions", "[cloud]") {
  // A sheared grid, far from Delaunay, with a second sheet on its middle line.
  const int n = 16;
  TriangleMesh mesh = plane(n, n, 1, 1);
  for (Vec3& p : mesh.positions) p.x() += 1.2 * p.y();
  const auto middle = [&](int j) { return Index(n / 2 + (n + 1) * j); };
  const Index below = Index(mesh.positions.size());
  for (int j = 0; j <= n; ++j)
    mesh.positions.push_back(mesh.positions[middle(j)] - Vec3(0, 0, 0.02));
  for (Index j = 0; j < Index(n); ++j) {
    mesh.faces.push_back({middle(j), middle(j + 1), below + j});
    mesh.faces.push_back({below + j, middle(j + 1), below + j + 1});
  }
  Patch complex = whole(make_node_mesh(mesh));
  const std::size_t faces = complex.corners.size();
  const double area = area_of(complex);
  const std::vector<float> weights = cloud::make_delaunay(complex);
  REQUIRE(weights.size() == complex.corners.size());
  CHECK(complex.corners.size() > faces);
  CHECK(area_of(complex, weights) == Approx(area));

  // The Laplacian of the positions, by cotangents, and its entries between different nodes.
  std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
  std::map<std::pair<Index, Index>, double> entries;
  for (std::size_t f = 0; f < complex.corners.size(); ++f) {
    const auto& c = complex.corners[f];
    const auto& l = complex.lengths[f];
    for (int k = 0; k < 3; ++k) {
      const double a = l[(k + 1) % 3], b = l[(k + 2) % 3];
      const double cotangent =
          weights[f] * (a * a + b * b - l[k] * l[k]) / (8 * triangle_area(l[0], l[1], l[2]));
      const Index i = c[k], j = c[(k + 1) % 3];
      sum[i] += cotangent * (mesh.positions[j] - mesh.positions[i]);
      sum[j] += cotangent * (mesh.positions[i] - mesh.positions[j]);
      if (i != j) entries[std::minmax(i, j)] += cotangent;
    }
  }
  for (const auto& [ends, entry] : entries) CHECK(entry > -1e-6);
  // Inside the sheet, away from its border and from the second sheet.
  for (int i = 3; i < n - 2; ++i)
    for (int j = 3; j < n - 2; ++j)
      if (std::abs(i - n / 2) > 2) CHECK(sum[i + (n + 1) * j].norm() < 1e-6);
}

}  // namespace onmesh
