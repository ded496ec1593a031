#include "onmesh/filter/working_plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

TEST_CASE("lengths grow with the unit, the area with its square", "[plan]") {
  const WorkingPlan working{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const FilterPlan plan = in_mesh_units(working, 0.25);
  const double lengths[] = {
      plan.sigma_spatial,  plan.radius,         plan.node_spacing,           plan.curved_spacing,
      plan.finest_spacing, plan.sample_spacing, plan.largest_sample_spacing, plan.texel_size,
      plan.diagonal,       plan.bridge};
  double expected = 0;
  for (const double length : lengths) CHECK(length == 0.25 * ++expected);
  CHECK(plan.surface_area == 11 * 0.0625);
}

void check_scaled(const FilterPlan& plan, const FilterPlan& scaled, double scale) {
  const auto length = [&](double a, double b) { CHECK(b == Approx(scale * a).epsilon(1e-9)); };
  length(plan.sigma_spatial, scaled.sigma_spatial);
  length(plan.radius, scaled.radius);
  length(plan.node_spacing, scaled.node_spacing);
  length(plan.curved_spacing, scaled.curved_spacing);
  length(plan.finest_spacing, scaled.finest_spacing);
  length(plan.sample_spacing, scaled.sample_spacing);
  length(plan.largest_sample_spacing, scaled.largest_sample_spacing);
  length(plan.texel_size, scaled.texel_size);
  length(plan.diagonal, scaled.diagonal);
  length(plan.bridge, scaled.bridge);
  CHECK(scaled.surface_area == Approx(scale * scale * plan.surface_area).epsilon(1e-9));
  CHECK(scaled.texels == plan.texels);
  CHECK(scaled.overlapped == plan.overlapped);
  CHECK(double(scaled.nodes) == Approx(double(plan.nodes)).margin(1));
  CHECK(double(scaled.samples) == Approx(double(plan.samples)).margin(1));
  CHECK(scaled.warnings == plan.warnings);
}

TriangleMesh scaled_by(double scale, TriangleMesh mesh) {
  for (Vec3& p : mesh.positions) p *= scale;
  return mesh;
}

FilterOptions options_at(double scale) {
  FilterOptions options;
  options.sigma_spatial = {0.1 * scale, Length::Unit::mesh};
  options.bridge = Length{4, Length::Unit::percent};
  return options;
}

TEST_CASE("the plan's lengths are those of the mesh, whatever its unit", "[plan][filter]") {
  const TriangleMesh mesh = make_chest(2, 0.05);
  const Image texture = make_image(128, 128, 1);
  FilterOptions options = options_at(1);
  options.samples = SampleKind::poisson;
  options.spacing = Length{2, Length::Unit::texel};
  const FilterPlan plan = plan_filter(mesh, texture, options);
  CHECK(plan.sigma_spatial == Approx(0.1));
  CHECK(plan.radius == Approx(0.25));
  CHECK(plan.diagonal == Approx(mesh.diagonal()));
  CHECK(plan.bridge == Approx(0.04 * mesh.diagonal()));
  CHECK(plan.sample_spacing == Approx(2 * plan.texel_size));
  for (const double scale : {1e3, 1e-3}) {
    options.sigma_spatial.value = 0.1 * scale;
    check_scaled(plan, plan_filter(scaled_by(scale, mesh), texture, options), scale);
  }
}

TEST_CASE("a mesh in another unit filters alike, and its report has that unit", "[plan][filter]") {
  const TriangleMesh mesh = make_chest(2, 0.05);
  const Image texture = make_texture(128, 128, Pattern::checker, 0.3, 7, 3);
  FilterReport report;
  const Image result = filter(mesh, texture, options_at(1), &report);
  CHECK(report.bridges > 0);
  // Powers of two round nothing, so that not even ties are decided otherwise.
  for (const double scale : {0x1p10, 0x1p-10}) {
    FilterReport other;
    const Image scaled = filter(scaled_by(scale, mesh), texture, options_at(scale), &other);
    CHECK(other.sigma_spatial == Approx(scale * report.sigma_spatial).epsilon(1e-9));
    CHECK(other.radius == Approx(scale * report.radius).epsilon(1e-9));
    CHECK(other.node_spacing == Approx(scale * report.node_spacing).epsilon(1e-9));
    CHECK(other.texel_size == Approx(scale * report.texel_size).epsilon(1e-9));
    CHECK(other.texels == report.texels);
    CHECK(other.bridges == report.bridges);
    double worst = 0;
    for (std::size_t k = 0; k < result.pixels.size(); ++k)
      worst = std::max(worst, std::abs(double(scaled.pixels[k]) - result.pixels[k]));
    CAPTURE(scale, worst);
    CHECK(worst == 0);
  }
}

}  // namespace
}  // namespace onmesh
