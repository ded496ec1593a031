// Exact distances up to a radius, and the closed forms that tests take for true.
#include "onmesh/distance/exact.h"
#include "onmesh/measure/nearby_geodesics.h"
#include "onmesh/mesh/clean.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/procedural/shapes.h"
#include "support/closed_forms.h"

namespace onmesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("exact distances within a radius are the whole mesh's", "[nearby_geodesics]") {
  const TriangleMesh mesh = make_torus(16, 8);
  ExactGeodesics whole(mesh);
  std::vector<SurfacePoint> points;
  for (Index f = 0; f < mesh.faces.size(); ++f) points.push_back({f, {0.2, 0.3, 0.5}});
  for (const double radius : {0.3, 1.0, kInfinity}) {
    const NearbyGeodesics nearby(mesh, radius);
    std::size_t within = 0;
    for (const Index f : {0U, 77U, 200U}) {
      const std::vector<double> all = whole.distances(points[f], points);
      const std::vector<double> some = nearby.distances(points[f], points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (all[i] <= radius) CHECK(some[i] == Approx(all[i]).margin(1e-12));
        if (all[i] > radius) CHECK(std::isnan(some[i]));
        within += all[i] <= radius;
      }
    }
    CHECK(within > 3);
  }
}

TEST_CASE("other components are not reached", "[nearby_geodesics]") {
  const TriangleMesh mesh = make_chest(1, 0.05);
  std::vector<SurfacePoint> centres;
  for (Index f = 0; f < mesh.faces.size(); ++f) centres.push_back({f, Vec3::Constant(1.0 / 3)});
  const auto d = NearbyGeodesics(mesh, kInfinity).distances(centres[0], centres);
  CHECK(std::count_if(d.begin(), d.end(), [](double x) { return std::isnan(x); }) == 12);
}

TEST_CASE("closed forms of developable surfaces agree with exact distances", "[nearby_geodesics]") {
  // The oracles against each other: what the accuracy tests and the comparison take for true.
  const auto check = [](const TriangleMesh& mesh, const Distances& closed_form) {
    ExactGeodesics exact(mesh);
    std::vector<SurfacePoint> points;
    for (Index f = 0; f < mesh.faces.size(); ++f) points.push_back({f, {0.21, 0.32, 0.47}});
    double worst = 0;
    for (std::size_t s = 0; s < points.size(); s += 5) {
      const auto a = closed_form(points[s], points), b = exact.distances(points[s], points);
      for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    }
    CHECK(worst < 1e-9);
  };
  const TriangleMesh folded = make_folded_sheet(4, 1.3, 0.7, 100, 3);
  check(folded, sheet_distances(folded));
  const TriangleMesh u_sheet = make_u_sheet(0.5, 1, 0.01, 2, 3);
  check(u_sheet, sheet_distances(u_sheet));
  const TriangleMesh cone = make_cone(270, 12, 3);
  check(cone, cone_distances(cone, 270));
  // Of the book, any two pages at a time are manifold.
  const TriangleMesh book = make_book(3);
  for (Index left_out = 0; left_out < 3; ++left_out) {
    std::vector<bool> keep(book.faces.size(), true);
    const std::size_t page = book.faces.size() / 3;
    for (std::size_t f = 0; f < page; ++f) keep[left_out * page + f] = false;
    // One page turned over, so that both are wound alike.
    TriangleMesh pages = clean(extract_faces(book, keep));
    check(pages, book_distances(pages));
  }
}

}  // namespace onmesh
