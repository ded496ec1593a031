#include "onmesh/filter/setup.h"

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/filter/filter.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"

namespace onmesh {
namespace {

FilterOptions options_for(SampleKind samples) {
  FilterOptions options;
  options.sigma_spatial = {6, Length::Unit::texel};
  options.sigma_range = 0.2;
  options.samples = samples;
  return options;
}

TEST_CASE("texels far wider than the mesh are filtered, or named as what is wrong", "[setup]") {
  TriangleMesh mesh = make_plane(4, 4);
  for (Vec2& uv : mesh.uvs) uv = Vec2(0.5, 0.5) + 1e-9 * uv;
  const Image texture = make_texture(128, 128, Pattern::checker, 0.3, 7, 3);
  FilterOptions options = options_for(SampleKind::texel);
  FilterReport report;
  filter(mesh, texture, options, &report);
  CHECK(report.texels == 1);
  options.sigma_spatial = {1e6, Length::Unit::texel};
  CHECK_THROWS_AS(filter(mesh, texture, options), InputError);
  CHECK_THROWS_WITH(filter(mesh, texture, options),
                    Catch::Contains("UVs cover hardly anything of the texture"));
}

TEST_CASE("the plan tells what the filter then does", "[setup][filter][slow]") {
  const TriangleMesh mesh = make_torus(32, 16);
  const Image texture = make_texture(256, 128, Pattern::checker, 0.3, 7, 3);
  FilterOptions options = options_for(GENERATE(SampleKind::texel, SampleKind::poisson));
  if (options.samples == SampleKind::poisson && GENERATE(true, false)) {
    options.spacing = Length{1.5, Length::Unit::texel};
  }
  const FilterPlan plan = plan_filter(mesh, texture, options);
  FilterReport report;
  filter(mesh, texture, options, &report);
  CHECK(plan.texels == report.texels);
  CHECK(plan.overlapped == report.overlapped);
  CHECK(plan.sigma_spatial == report.sigma_spatial);
  CHECK(plan.radius == report.radius);
  CHECK(plan.node_spacing == report.node_spacing);
  CHECK(plan.sample_spacing == report.sample_spacing);
  CHECK(plan.texel_size == report.texel_size);
  CHECK(plan.warnings == report.warnings);
  CAPTURE(plan.samples, report.samples, plan.nodes, report.nodes);
  const bool by_texels = options.samples == SampleKind::texel;
  CHECK(double(plan.samples) == Approx(double(report.samples)).epsilon(by_texels ? 1e-12 : 0.05));
  // An upper estimate: as if the surface were curved everywhere.
  CHECK(plan.nodes >= report.nodes);
  CHECK(double(plan.nodes) < 1.5 * double(report.nodes));
  // Every texel has the samples of a disk of 15 texels, pi 15^2 = 707, or a little more as the
  // texels of a torus have different areas. Poisson samples are fewer or more than texels.
  const double texels_in_disk = double(report.pairs) / double(report.samples);
  CHECK(texels_in_disk > 700);
  CHECK(texels_in_disk < 850);
  std::vector<std::string> stages;
  for (const StageTime& time : report.stages) stages.push_back(time.stage);
  CHECK(stages ==
        std::vector<std::string>{"texel map", "refine", "samples", "features", "filter", "gutter"});
}

TEST_CASE("runs that take more memory than they may are refused before the work", "[setup]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const Image texture = make_texture(64, 64, Pattern::checker, 0.3, 7);
  FilterOptions options = options_for(SampleKind::texel);
  const FilterPlan plan = plan_filter(mesh, texture, options);
  CHECK(plan.memory_bytes > resident_memory_bytes() + 64 * 64 * 3 * sizeof(float));
  CHECK(plan.memory_bytes < plan.memory_limit);
  options.max_memory = plan.memory_bytes + (64 << 20);  // what is resident changes now and then
  FilterReport report;
  filter(mesh, texture, options, &report);
  options.max_memory = plan.memory_bytes / 2;
  CHECK_THROWS_AS(filter(mesh, texture, options), InputError);
  CHECK_THROWS_WITH(filter(mesh, texture, options),
                    Catch::Contains("of memory") && Catch::Contains("may be used"));
  CHECK(plan_filter(mesh, texture, options).memory_limit == options.max_memory);
}

TEST_CASE("plans of more nodes or samples than integers count say that they are many", "[setup]") {
  const TriangleMesh mesh = make_plane(1, 1, 100, 100);
  const Image texture = make_texture(16, 16, Pattern::checker, 0.3, 7);
  FilterOptions options = options_for(SampleKind::poisson);
  options.spacing = Length{1e-9, Length::Unit::mesh};
  const FilterPlan plan = plan_filter(mesh, texture, options);
  CHECK(plan.samples >= std::uint64_t(1e18));
  CHECK(plan.memory_bytes >= std::uint64_t(1e18));
  CHECK_THROWS_AS(filter(mesh, texture, options), InputError);
  options = options_for(SampleKind::texel);
  options.node_spacing = Length{1e-9, Length::Unit::mesh};
  CHECK_THROWS_WITH(plan_filter(mesh, texture, options),
                    Catch::StartsWith("node_spacing: would make about 1000000000000000000 nodes"));
}

TEST_CASE("spacings are set for Poisson samples alone", "[setup]") {
  const TriangleMesh mesh = make_cube();
  const Image texture = make_image(96, 72, 3);
  const FilterSetup texel =
      set_up_filter(mesh, one_texture(texture, {}), options_for(SampleKind::texel));
  CHECK_FALSE(texel.graded);
  CHECK(texel.lengths.sample_spacing == 0);
  CHECK(texel.mesh_plan.samples == texel.mesh_plan.texels);
  FilterOptions options = options_for(SampleKind::poisson);
  CHECK(set_up_filter(mesh, one_texture(texture, {}), options).graded);
  options.r_coef = 0.01;
  const FilterSetup poisson = set_up_filter(mesh, one_texture(texture, {}), options);
  CHECK_FALSE(poisson.graded);
  CHECK(poisson.mesh_plan.sample_spacing == Approx(0.01 * mesh.mean_edge_length()));
  CHECK(poisson.mesh_plan.largest_sample_spacing == poisson.mesh_plan.sample_spacing);
}

TEST_CASE("a texture of nothing but alpha is refused", "[setup]") {
  Image texture = make_image(8, 8, 1);
  texture.alpha_channel = 0;
  CHECK_THROWS_WITH(plan_filter(make_plane(1, 1), texture, {}),
                    "the texture has no channel but alpha: nothing to filter");
}

TEST_CASE("texels without number are refused before they are looked for", "[setup]") {
  TriangleMesh mesh = make_plane(1, 1);
  for (Vec2& uv : mesh.uvs) uv *= 1000;
  const Image texture = make_texture(32, 32, Pattern::checker, 0.3, 7);
  FilterOptions options = options_for(SampleKind::texel);
  options.max_memory = std::uint64_t{1} << 30;
  CHECK_THROWS_WITH(
      plan_filter(mesh, texture, options),
      Catch::Contains("for 1024000000 texels on the surface, and 1.07 GB may be used"));
}

}  // namespace
}  // namespace onmesh
