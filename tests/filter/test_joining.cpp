// Surfaces in pieces that were meant to be one filter like the whole.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/filter/filter.h"
#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/procedural/texture.h"
#include "support/images.h"
#include "support/mesh_parts.h"
#include "support/rounded_meshes.h"

namespace onmesh {
namespace {

using Catch::Contains;

FilterOptions blur(double sigma) {
  FilterOptions options;
  options.kind = FilterKind::gaussian;
  options.sigma_spatial = {sigma, Length::Unit::mesh};
  return options;
}

/// The sheet [0,2] x [0,1], cut at x = 1, with `left` and `right` rows; all UVs within a tile.
TriangleMesh cut_sheet(int left, int right, double gap = 0) {
  TriangleMesh mesh =
      side_by_side(rectangle(0, 0, 1, 1, 3, left), rectangle(1, 0, 1, 1, 3, right), {gap, 0, 0});
  for (Vec2& uv : mesh.uvs) uv = uv / 2.2 + Vec2(5, 5) / 110;
  return mesh;
}

Image steps() {
  Image image = make_image(110, 110, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.pixels[std::size_t(y * image.width + x)] = x < 55 ? 0.2F : 0.8F;
  return image;
}

TEST_CASE("a sphere whose triangles are rounded each by itself filters like the welded one",
          "[joining]") {
  TriangleMesh whole = weld(make_sphere(3));
  round_to_floats(whole, 1, [](Index) { return false; });
  const Image texture = make_texture(128, 128, Pattern::checker, 0.3, 7, 1);
  const Image expected = filter(whole, texture, blur(0.1));
  FilterReport report;
  const Image result = filter(rounded_soup(whole, 5), texture, blur(0.1), &report);
  CHECK(report.joined_edges > 100);
  CHECK(report.near_edges == 0);
  CHECK(largest_difference(result, expected) < 1.0F / 255);
}

TEST_CASE("a T-junction is filtered across", "[joining]") {
  const Image expected = filter(cut_sheet(4, 4), steps(), blur(0.1));
  for (const auto& [left, right] : {std::pair{4, 3}, {1, 7}, {5, 5}}) {
    FilterReport report;
    const Image result = filter(cut_sheet(left, right), steps(), blur(0.1), &report);
    CHECK(report.warnings.empty());
    CHECK(largest_difference(result, expected) < 2.0F / 255);
  }
}

TEST_CASE("faces chosen and faces in errors are those of the mesh as given, split or not",
          "[joining]") {
  TriangleMesh mesh = cut_sheet(1, 3);
  const std::size_t faces = mesh.faces.size();
  FilterOptions options = blur(0.1);
  for (std::size_t f = 0; f < faces; ++f) options.faces.push_back(f >= 6);
  const PreparedMesh prepared = prepare_mesh(mesh, one_texture(steps(), options), options);
  CHECK(prepared.joining.t_junctions == 2);
  REQUIRE(prepared.cleaning.kept.size() == faces + 2);
  for (std::size_t f = 0; f < prepared.cleaning.kept.size(); ++f)
    CHECK((prepared.map.texel_area[f] > 0) == (prepared.cleaning.kept[f] >= 6));
  mesh.face_uvs[20][1] = Index(mesh.uvs.size());
  mesh.uvs.emplace_back(40000, 0);
  CHECK_THROWS_WITH(plan_filter(mesh, steps(), {}), "face 20: its UVs span more than 16384 tiles");
}

TEST_CASE("gaps within a texel are named with what would close them", "[joining]") {
  FilterOptions options = blur(0.1);
  FilterPlan plan = plan_filter(cut_sheet(4, 4, 0.004), steps(), options);
  CHECK(plan.near_edges == 8);
  CAPTURE(plan.warnings);
  REQUIRE(plan.warnings.size() == 1);
  CHECK(
      plan.warnings[0] ==
      "8 boundary edges lie within a texel of others but stay apart; weld=0.0041 would join them");
  options.weld = Length{0.0041, Length::Unit::mesh};
  plan = plan_filter(cut_sheet(4, 4, 0.004), steps(), options);
  CHECK(plan.warnings.empty());
  CHECK(plan.joined_edges == 4);
  // Too wide for edges of so many rows.
  plan = plan_filter(cut_sheet(40, 40, 0.004), steps(), blur(0.1));
  REQUIRE(plan.warnings.size() == 1);
  CHECK_THAT(plan.warnings[0], Contains("bridge=0.0041 would join them"));
  // Farther than a texel apart.
  plan = plan_filter(cut_sheet(4, 4, 0.03), steps(), blur(0.1));
  CHECK(plan.near_edges == 0);
  CHECK(plan.warnings.empty());
}

TEST_CASE("with weld=0 only what is equal is joined", "[joining]") {
  FilterOptions options = blur(0.1);
  options.weld = Length{0, Length::Unit::mesh};
  const FilterPlan plan = plan_filter(cut_sheet(4, 3), steps(), options);
  CHECK(plan.joined_edges == 0);
  CHECK(plan.t_junctions == 0);
  CHECK(plan.near_edges > 0);
  options.weld = Length{2, Length::Unit::texel};
  CHECK_THROWS_WITH(plan_filter(cut_sheet(4, 3), steps(), options), Contains("weld"));
  options.weld = Length{-1, Length::Unit::mesh};
  CHECK_THROWS_WITH(plan_filter(cut_sheet(4, 3), steps(), options), Contains("weld"));
}

TEST_CASE("coordinates coarser than the edges are named as that", "[joining]") {
  TriangleMesh mesh = make_plane(12, 12, 3, 3);
  for (Vec3& p : mesh.positions) p += Vec3(412345.678, 5412345.678, 231.5);
  CHECK(plan_filter(mesh, make_image(32, 32, 1), blur(0.5)).warnings.empty());
  round_to_floats(mesh, 1, [](Index) { return false; });
  const FilterPlan plan = plan_filter(mesh, make_image(32, 32, 1), blur(0.5));
  REQUIRE_FALSE(plan.warnings.empty());
  CHECK_THAT(plan.warnings[0], Contains("too coarsely: float32 near 5412348 has steps of 0.5"));
  for (const std::string& warning : plan.warnings) CHECK_THAT(warning, !Contains("repeated"));
}

}  // namespace
}  // namespace onmesh
