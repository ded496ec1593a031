// Parts of a mesh that no surface joins: they influence each other over bridges only.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/mesh/components.h"
#include "onmesh/procedural/shapes.h"
#include "support/filter_error.h"
#include "support/images.h"

namespace onmesh {
namespace {

/// Other colours in the texels of one component.
Image repaint(const TriangleMesh& mesh, const Image& texture, Index component) {
  const TexelMap map = make_texel_map(mesh, texture.width, texture.height);
  const FaceComponents components = connected_components(mesh);
  Image image = texture;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (components.of_face[f] != component) continue;
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      float* const texel = image.texel(map.tiles[0].texel(map.claims[k]));
      for (int c = 0; c < image.channels; ++c) texel[c] = 1 - texel[c];
    }
  }
  return image;
}

/// Largest difference of two images in the texels of one component.
double difference(const TriangleMesh& mesh, const Image& a, const Image& b, Index component) {
  const TexelMap map = make_texel_map(mesh, a.width, a.height);
  const FaceComponents components = connected_components(mesh);
  double worst = 0;
  std::size_t texels = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (components.of_face[f] != component) continue;
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k, ++texels) {
      const Index t = map.tiles[0].texel(map.claims[k]);
      for (int c = 0; c < a.channels; ++c)
        worst = std::max(worst, std::abs(double(a.texel(t)[c]) - b.texel(t)[c]));
    }
  }
  REQUIRE(texels > 100);
  return worst;
}

TEST_CASE("no component influences another unless it is bridged", "[soup][bridge][slow]") {
  const TriangleMesh chest = make_chest(1, 0.05);
  const Image texture = noisy_checker(192, 192);
  const Image other = repaint(chest, texture, 1);
  FilterOptions options = options_in_mesh_units(FilterKind::gaussian, 0.3);
  options.radius = Length{0.6, Length::Unit::mesh};
  options.samples = GENERATE(SampleKind::texel, SampleKind::poisson);
  options.distance = GENERATE(DistanceMethod::unfold, DistanceMethod::cloud);
  CHECK(difference(chest, filter(chest, texture, options), filter(chest, other, options), 0) == 0);
  options.bridge = Length{0.1, Length::Unit::mesh};
  FilterReport report;
  CHECK(difference(chest, filter(chest, texture, options, &report), filter(chest, other, options),
                   0) > 0.2);
  CHECK(report.bridges > 20);
  // A bridge that is too short is none.
  options.bridge = Length{0.04, Length::Unit::mesh};
  CHECK(difference(chest, filter(chest, texture, options, &report), filter(chest, other, options),
                   0) == 0);
  CHECK(report.bridges == 0);
}

TEST_CASE("parallel sheets closer than the nodes do not leak into each other", "[soup]") {
  // Two squares above each other, each with half of the atlas.
  TriangleMesh sheets = make_plane(1, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    sheets.positions.push_back(sheets.positions[i] + Vec3(0, 0, 0.05));
    sheets.uvs[i].x() /= 2;
    sheets.uvs.push_back(sheets.uvs[i] + Vec2(0.5, 0));
  }
  for (std::size_t f = 0; f < 2; ++f) {
    const auto v = sheets.faces[f], u = sheets.face_uvs[f];
    sheets.faces.push_back({v[0] + 4, v[1] + 4, v[2] + 4});
    sheets.face_uvs.push_back({u[0] + 4, u[1] + 4, u[2] + 4});
    sheets.face_materials.push_back(kNone);
  }
  const Image texture = noisy_checker(64, 64);
  FilterOptions options = options_in_mesh_units(
      FilterKind::gaussian, 0.1,
      GENERATE(DistanceMethod::unfold, DistanceMethod::heat, DistanceMethod::cloud));
  options.node_spacing = Length{0.1, Length::Unit::mesh};
  const Image other = repaint(sheets, texture, 1);
  CHECK(difference(sheets, filter(sheets, texture, options), filter(sheets, other, options), 0) ==
        0);
}

}  // namespace
}  // namespace onmesh
