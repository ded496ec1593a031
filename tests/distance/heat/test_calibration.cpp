// The fit of heat distances to the marched near field.
#include "onmesh/distance/heat/calibration.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/distance/unfold.h"
#include "support/distance_errors.h"
#include "support/simple_shapes.h"

namespace onmesh {
namespace {

using namespace simple;

TEST_CASE("most of what is wrong alike along every ray is taken out", "[calibration]") {
  const int n = 24;
  const TriangleMesh mesh = plane(n, n, n, n, 0.25);  // edges of about 1
  const NodeMesh nodes = make_node_mesh(mesh);
  Patch patch = whole(nodes);
  const double reach = 12, kernel = reach - 2 * patch.longest_edge;
  heat::Calibration calibration(patch, {kernel, reach});
  REQUIRE(calibration.near_reach() < 0.9 * kernel);
  DistanceTable table = fill(*make_unfold(), patch, calibration.near_reach());
  for (const Index source : {Index(n / 2 * (n + 1) + n / 2), Index(0), Index(n / 2)}) {
    // A constant, and an error that depends on the direction only.
    std::vector<double> phi;
    double bent = 0;
    for (const Vec3& p : mesh.positions) {
      const Vec3 d = p - mesh.positions[source];
      const double error = 0.1 * std::cos(4 * std::atan2(d.y(), d.x()) + 1);
      phi.push_back(d.norm() + 0.7 + error);
      bent = std::max(bent, std::abs(error));
    }
    float* const row = table.squared.data() + std::size_t(source) * table.columns;
    calibration.complete(source, phi, row);
    double worst = 0, mean = 0;
    int count = 0;
    for (Index i = 0; i < phi.size(); ++i) {
      const double d = (mesh.positions[i] - mesh.positions[source]).norm();
      if (d > reach + 1.5) CHECK(row[i] == kUnreachable);
      if (d > reach) continue;
      REQUIRE(row[i] != kUnreachable);
      if (d <= heat::kNearShare * kernel || d > kernel) continue;
      const double error = std::abs(std::sqrt(double(row[i])) - d);
      worst = std::max(worst, error);
      mean += error;
      ++count;
    }
    CAPTURE(source, worst, mean / count);
    CHECK(count > 5);
    CHECK(worst < 0.3 * bent);
    CHECK(mean / count < 0.05 * bent);  // of 0.64
  }
}

TEST_CASE("what the march did not reach keeps its solution up to a constant", "[calibration]") {
  // Beyond a node that no face joins to the source nothing is known.
  TriangleMesh mesh = plane(6, 6, 6, 6);
  mesh.positions.emplace_back(3, 3, 0.1);
  const NodeMesh nodes = make_node_mesh(mesh);
  const Patch patch = whole(nodes);
  heat::Calibration calibration(patch, {8 - 2 * patch.longest_edge, 8});
  DistanceTable table = fill(*make_unfold(), patch, calibration.near_reach());
  std::vector<double> phi;
  for (const Vec3& p : mesh.positions) phi.push_back((p - mesh.positions[0]).norm() - 5);
  phi.back() = std::numeric_limits<double>::infinity();
  calibration.complete(0, phi, table.squared.data());
  CHECK(table.row(0)[phi.size() - 1] == kUnreachable);
  int compared = 0;
  for (Index i = 0; i + 1 < phi.size(); ++i) {
    if (phi[i] + 5 >= 8) continue;
    CHECK(std::sqrt(double(table.row(0)[i])) == Approx(phi[i] + 5).margin(1e-4));
    ++compared;
  }
  CHECK(compared > 25);
}

TEST_CASE("the near field is a share of the radius, however far tables reach", "[calibration]") {
  const TriangleMesh mesh = plane(8, 8, 8, 8);
  const Patch patch = whole(make_node_mesh(mesh));
  for (const double beyond : {0.0, 1.0, 5.0, 1e6}) {
    const heat::Calibration calibration(patch, {6, 6 + beyond});
    CHECK(calibration.near_reach() == heat::kNearShare * 6);
  }
  CHECK(heat::Calibration(patch, {1, 9}).near_reach() == 2 * patch.longest_edge);
}

}  // namespace
}  // namespace onmesh
