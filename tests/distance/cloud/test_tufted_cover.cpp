#include "onmesh/distance/cloud/tufted_cover.h"

#include <catch2/catch.hpp>
#include <map>

#include "support/areas.h"
#include "support/distance_errors.h"
#include "support/simple_shapes.h"

namespace onmesh {

using namespace simple;

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
  const std::vector<float> weights = cloud::flip_tufted_cover(complex);
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
