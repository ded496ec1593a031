#include "onmesh/nodes/sizing_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

RefineOptions spaced(double spacing) {
  RefineOptions options;
  options.spacing = spacing;
  return options;
}

std::vector<double> wanted(const TriangleMesh& mesh, const RefineOptions& options) {
  return wanted_spacing(mesh, EdgeTable(mesh), options);
}

}  // namespace

TEST_CASE("on a plane and on a cylinder the spacing is the largest everywhere", "[sizing_field]") {
  for (const TriangleMesh& mesh : {make_plane(5, 4), make_cylinder(24, 6)})
    for (const double spacing : wanted(mesh, spaced(0.3)))
      CHECK(spacing == Approx(0.3).epsilon(1e-9));
}

TEST_CASE("a cone's apex wants what its missing angle says", "[sizing_field]") {
  const RefineOptions options = spaced(0.1);
  for (const double sector : {200.0, 270.0, 355.0}) {
    const double bend = (360 - sector) * std::numbers::pi / 180;
    const TriangleMesh mesh = make_cone(sector, 24, 4);
    const std::vector<double> spacing = wanted(mesh, options);
    CHECK(*std::min_element(spacing.begin(), spacing.end()) ==
          Approx(std::max(0.1 / 4, 0.1 / (1 + options.sharpness * bend))).epsilon(1e-6));
  }
}

TEST_CASE("the spacing grows along edges as fast as it may, no faster", "[sizing_field]") {
  const TriangleMesh mesh = make_cone(200, 24, 12);
  const RefineOptions options = spaced(1);
  const std::vector<double> spacing = wanted(mesh, options);
  const EdgeTable edges(mesh);
  double steepest = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges.vertices(e);
    const double length = (mesh.positions[a] - mesh.positions[b]).norm();
    steepest = std::max(steepest, std::abs(spacing[a] - spacing[b]) / length);
  }
  CHECK(steepest == Approx(options.growth).epsilon(1e-9));
}

TEST_CASE("pages do not bend distances at their straight spine, a knot does", "[sizing_field]") {
  for (const double spacing : wanted(make_book(4), spaced(0.1)))
    CHECK(spacing == Approx(0.1).epsilon(1e-9));
  const TriangleMesh tie = make_bow_tie(4);
  const std::vector<double> at = wanted(tie, spaced(0.1));
  for (Index v = 0; v < at.size(); ++v)
    CHECK((at[v] == Approx(0.025)) == (tie.positions[v].norm() < 1e-12));
}

TEST_CASE("far from needed faces the wanted spacing grows with the distance", "[sizing_field]") {
  const TriangleMesh mesh = make_plane(10, 10, 10, 10);
  RefineOptions options = spaced(0.1);
  options.reach = 2;
  options.needed.assign(mesh.faces.size(), false);
  options.needed[0] = true;
  const Remoteness remoteness(mesh, options);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const SurfacePoint point{f, Vec3(0.2, 0.3, 0.5)};
    double nearest = 1e9;  // to the needed face's corners: its points are within an edge of them
    for (const Vec3& corner : mesh.corners(0))
      nearest = std::min(nearest, (mesh.position(point) - corner).norm());
    CHECK(remoteness(point) <= options.growth * std::max(0.0, nearest - 2) + 1e-12);
    CHECK(remoteness(point) >= options.growth * std::max(0.0, nearest - 2 - 1) - 1e-12);
  }
  CHECK(remoteness({0, Vec3::Constant(1.0 / 3)}) == 0);
  options.needed.clear();
  CHECK(Remoteness(mesh, options)({99, Vec3::Constant(1.0 / 3)}) == 0);
}

TEST_CASE("refinement refuses options outside their domain by their fields", "[sizing_field]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const auto refused = [&](const std::function<void(RefineOptions&)>& change) {
    RefineOptions options = spaced(0.1);
    change(options);
    try {
      check_refine_options(mesh, options);
    } catch (const OptionError& error) {
      return error.option();
    }
    return std::string();
  };
  using R = RefineOptions;
  CHECK(refused([](R&) {}).empty());
  CHECK(refused([](R& o) { o.spacing = 0; }) == "spacing");
  CHECK(refused([](R& o) { o.curved = 0.2; }) == "curved");
  CHECK(refused([](R& o) { o.finest = -1; }) == "finest");
  CHECK(refused([](R& o) { o.flatness = -1; }) == "flatness");
  CHECK(refused([](R& o) { o.spread = std::nan(""); }) == "spread");
  CHECK(refused([](R& o) { o.sharpness = -1; }) == "sharpness");
  CHECK(refused([](R& o) { o.growth = 0; }) == "growth");
  CHECK(refused([](R& o) { o.min_angle_degrees = 31; }) == "min_angle_degrees");
  CHECK(refused([](R& o) { o.reach = -1; }) == "reach");
  CHECK(refused([](R& o) { o.needed.assign(3, true); }) == "needed");
  CHECK(refused([](R& o) { o.least_useful.assign(1, 1); }) == "least_useful");
}

}  // namespace onmesh
