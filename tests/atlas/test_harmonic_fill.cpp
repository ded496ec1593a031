#include "onmesh/atlas/harmonic_fill.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/procedural/shapes.h"
#include "support/mesh_parts.h"

namespace onmesh {
namespace {

/// Harmonic in the plane.
double harmonic(const Vec2& p) {
  return std::exp(2 * (p.x() - 1)) * std::cos(2 * p.y()) / 2 +
         0.1 * (p.x() * p.x() - p.y() * p.y());
}

/// The largest error of filling texels with is_hole(place), as a share of the values' spread.
template <class IsHole>
double error_of_fill(const TriangleMesh& mesh, int width, int height, const std::vector<Vec2>& flat,
                     const IsHole& is_hole) {
  const TexelMap map = make_texel_map(mesh, width, height);
  Image image = make_image(width, height, 1);
  std::vector<Index> missing;
  std::vector<double> truth(image.pixels.size(), 0);
  double low = 1e9, high = -1e9;
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const Vec3 b = map.barycentric(f, map.claims[k]);
      const Index texel = map.tile_of(f).texel(map.claims[k]);
      Vec2 place = Vec2::Zero();
      for (int c = 0; c < 3; ++c) place += b[c] * flat[mesh.faces[f][std::size_t(c)]];
      truth[texel] = harmonic(place);
      low = std::min(low, truth[texel]);
      high = std::max(high, truth[texel]);
      const bool hole = is_hole(place);
      if (hole) missing.push_back(texel);
      image.pixels[texel] = hole ? std::numeric_limits<float>::quiet_NaN() : float(truth[texel]);
    }
  }
  std::sort(missing.begin(), missing.end());
  REQUIRE(missing.size() > 100);
  CHECK(harmonic_fill(mesh, map, missing, {0}, texels_of(image)) == 0);
  double worst = 0;
  for (const Index texel : missing)
    worst = std::max(worst, std::abs(image.pixels[texel] - truth[texel]));
  return worst / (high - low);
}

bool in_middle(const Vec2& p) {
  return std::abs(p.x() - 0.5) < 0.3 && std::abs(p.y() - 0.5) < 0.35;
}

std::vector<Vec2> flat_positions(const TriangleMesh& mesh) {
  std::vector<Vec2> flat;
  for (const Vec3& p : mesh.positions) flat.push_back(p.head<2>());
  return flat;
}

}  // namespace

TEST_CASE("a hole in a flat sheet gets the harmonic function of its border", "[harmonic_fill]") {
  TriangleMesh mesh = make_plane(1, 1);
  const std::vector<Vec2> flat = flat_positions(mesh);
  SECTION("texels are squares") { CHECK(error_of_fill(mesh, 128, 128, flat, in_middle) < 1e-3); }
  SECTION("texels are stretched") { CHECK(error_of_fill(mesh, 256, 64, flat, in_middle) < 2e-3); }
  SECTION("texels are sheared") {
    for (Vec2& uv : mesh.uvs) uv = {uv.x() / 2 + uv.y() / 2, uv.y()};
    CHECK(error_of_fill(mesh, 256, 128, flat, in_middle) < 3e-3);
  }
  SECTION("texels are turned") {
    for (Vec2& uv : mesh.uvs)
      uv = Vec2(0.5, 0.5) + 0.6 * Vec2(0.8 * (uv.x() - 0.5) - 0.6 * (uv.y() - 0.5),
                                       0.6 * (uv.x() - 0.5) + 0.8 * (uv.y() - 0.5));
    CHECK(error_of_fill(mesh, 200, 200, flat, in_middle) < 2e-3);
  }
}

TEST_CASE("opposite borders of a repeated texture are no neighbours", "[harmonic_fill]") {
  // A hole from the middle to the right border; the left one has other values.
  const TriangleMesh mesh = make_plane(1, 1);
  const TexelMap map = make_texel_map(mesh, 32, 32);
  Image image = make_image(32, 32, 1);
  std::vector<Index> missing;
  for (Index t = 0; t < 32 * 32; ++t) {
    image.pixels[t] = t % 32 < 8 ? 0.F : 1.F;
    if (t % 32 >= 16) missing.push_back(t);
  }
  CHECK(harmonic_fill(mesh, map, missing, {0}, texels_of(image)) == 0);
  for (const Index texel : missing) REQUIRE(image.pixels[texel] == Approx(1).margin(1e-5));
}

TEST_CASE("what is filled is smooth over seams", "[harmonic_fill]") {
  // Two halves of the sheet, the right one turned by 90 degrees and smaller in the atlas.
  TriangleMesh mesh = make_plane(4, 4);
  const std::vector<Vec2> flat = flat_positions(mesh);
  std::vector<Vec2> uvs;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    double middle = 0;
    for (const Index v : mesh.faces[f]) middle += flat[v].x() / 3;
    const bool right = middle > 0.5;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 p = flat[mesh.faces[f][k]];
      uvs.push_back(right ? Vec2(0.55 + 0.4 * p.y(), 0.9 - 0.8 * (p.x() - 0.5))
                          : Vec2(0.02 + 0.96 * p.x(), 0.02 + 0.96 * p.y()));
      mesh.face_uvs[f][k] = Index(uvs.size() - 1);
    }
  }
  // The same UV index for the same corner of a chart.
  mesh.uvs.clear();
  for (auto& face : mesh.face_uvs) {
    for (Index& uv : face) {
      const auto same = std::find(mesh.uvs.begin(), mesh.uvs.end(), uvs[uv]);
      const auto number = Index(same - mesh.uvs.begin());
      if (same == mesh.uvs.end()) mesh.uvs.push_back(uvs[uv]);
      uv = number;
    }
  }
  CHECK(error_of_fill(mesh, 160, 160, flat, in_middle) < 0.01);
}

TEST_CASE("a part without any value is left, others are filled", "[harmonic_fill]") {
  const TriangleMesh both =
      side_by_side(textured_square(1, {0.5, 1}), textured_square(1, {0.5, 1}, {0.5, 0}), {0, 0, 5});
  const TexelMap map = make_texel_map(both, 16, 8);
  Image image = make_image(16, 8, 1);
  std::vector<Index> missing;
  for (Index t = 0; t < 16 * 8; ++t) {
    const bool known = t % 16 < 4;
    image.pixels[t] = known ? 0.5F : std::numeric_limits<float>::quiet_NaN();
    if (!known) missing.push_back(t);
  }
  CHECK(harmonic_fill(both, map, missing, {0}, texels_of(image)) == 64);
  for (Index t = 0; t < 16 * 8; ++t) {
    if (t % 16 < 8) CHECK(image.pixels[t] == Approx(0.5));
    if (t % 16 >= 8) CHECK(std::isnan(image.pixels[t]));
  }
}

}  // namespace onmesh
