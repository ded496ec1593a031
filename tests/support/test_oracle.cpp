// The oracle against what can be worked out by hand, and its rasteriser against the texel map: they
// share nothing, so a mistake in either shows.
#include "support/oracle.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/procedural/shapes.h"
#include "support/atlas_meshes.h"
#include "support/closed_forms.h"
#include "support/recut_atlas.h"

namespace onmesh {
namespace {

/// Claim by claim, in the map's order.
void check_same_texels(const TriangleMesh& mesh, int width, int height, Wrap wrap = Wrap::repeat) {
  const TexelMap map = make_texel_map(mesh, width, height, {wrap, {}});
  const TexelPoints own = texel_points(mesh, width, height, wrap == Wrap::repeat);
  INFO(mesh.faces.size() << " faces, " << width << " x " << height);
  REQUIRE(own.texels.size() == map.claims.size());
  std::vector<Index> chart_of(map.charts, kNone);
  Index places = 0, areas = 0, charts = 0;  // that differ
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      const SurfacePoint& point = own.points[k];
      places += point.face != f || own.texels[k] != map.tiles[0].texel(map.claims[k]) ||
                (point.barycentric - map.barycentric(f, map.claims[k])).norm() > 1e-7;
      areas += std::abs(own.areas[k] / map.texel_area[f] - 1) > 1e-9;
      Index& chart = chart_of[map.chart_of_face[f]];
      if (chart == kNone) chart = own.charts[k];
      charts += own.charts[k] != chart;
    }
  }
  CHECK(places == 0);
  CHECK(areas == 0);
  CHECK(charts == 0);
  // Different charts have different numbers.
  std::sort(chart_of.begin(), chart_of.end());
  const auto last = std::find(chart_of.begin(), chart_of.end(), kNone);
  CHECK(std::adjacent_find(chart_of.begin(), last) == last);
}

std::vector<TriangleMesh> all_shapes() {
  return {make_plane(3, 2),
          make_folded_sheet(3, 1, 1, 80),
          make_u_sheet(1, 1, 0.02, 2, 3),
          make_gentle_sheet(4),
          make_cube(1),
          make_cube(7),
          make_sphere(2),
          make_torus(12, 7),
          make_cone(270, 9, 3),
          make_cylinder(7, 2),
          make_saddle(5),
          make_blob(3, 4),
          make_book(2),
          make_bow_tie(3),
          make_moebius(3),
          make_chest(2)};
}

/// The atlas turned, shrunk, moved and mirrored if asked for; charts leave [0,1].
TriangleMesh turned_atlas(TriangleMesh mesh, double angle, bool mirrored) {
  for (Vec2& uv : mesh.uvs) {
    const Vec2 d = 0.7 * uv;
    uv = Vec2(std::cos(angle) * d.x() - std::sin(angle) * d.y() - 0.37,
              std::sin(angle) * d.x() + std::cos(angle) * d.y() + 2.61);
    if (mirrored) uv.x() = 1 - uv.x();
  }
  return mesh;
}

TEST_CASE("the oracle finds the texel map's texels on every shape", "[oracle]") {
  for (const TriangleMesh& mesh : all_shapes()) {
    check_same_texels(mesh, 64, 64);
    check_same_texels(mesh, 192, 128);
    check_same_texels(mesh, 97, 53);
  }
}

TEST_CASE("the oracle finds the texel map's texels where charts have no centre", "[oracle]") {
  for (const TriangleMesh& mesh : all_shapes()) {
    for (const int size : {1, 2, 3, 5, 8}) check_same_texels(mesh, size, size);
  }
}

TEST_CASE("the oracle finds the texel map's texels in turned, mirrored and repeated atlases",
          "[oracle]") {
  double angle = 0.3;
  for (const TriangleMesh& mesh : all_shapes()) {
    for (const bool mirrored : {false, true}) {
      const TriangleMesh turned = turned_atlas(mesh, angle += 0.7, mirrored);
      check_same_texels(turned, 60, 44);
      check_same_texels(turned, 60, 44, Wrap::clamp);
    }
  }
}

TEST_CASE("the oracle finds the texel map's texels in an atlas cut anew", "[oracle]") {
  for (const TriangleMesh& mesh : {make_plane(8, 6, 4, 3), make_cube(7)}) {
    const RecutAtlas recut = recut_atlas(mesh, make_image(128, 128, 1), 5);
    check_same_texels(recut.mesh, recut.image.width, recut.image.height);
  }
}

TEST_CASE("the oracle's centres on a shared edge belong to the lowest face", "[oracle]") {
  const TriangleMesh square = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, 3);
  const TexelPoints points = texel_points(square, 4, 4);
  REQUIRE(points.texels.size() == 16);
  // From the lower left corner up, four centres lie on the diagonal.
  CHECK(points.points[9].face == 0);
  CHECK(points.points[10].face == 1);
  // By rows from the top: one texel of the first row is the lower face's, two of the second, ...
  CHECK(std::vector<Index>(points.texels.begin(), points.texels.begin() + 10) ==
        std::vector<Index>{3, 6, 7, 9, 10, 11, 12, 13, 14, 15});
  for (const double area : points.areas) CHECK(area == Approx(9.0 / 16));
  CHECK((points.positions[0] - Vec3(3 * 0.875, 3 * 0.875, 0)).norm() < 1e-12);
}

TEST_CASE("the oracle gives a chart without a centre the texel that it overlaps most", "[oracle]") {
  // In texels of a 4 x 4 image: most of the square around (1, 2.6) is in column 0, row 2.
  const auto at = [](double x, double y) { return Vec2(x / 4, 1 - y / 4); };
  const TriangleMesh mesh =
      flat({at(0.7, 2.6), at(1.1, 2.6), at(1.1, 2.8), at(0.7, 2.8)}, {{0, 1, 2}, {0, 2, 3}});
  const TexelPoints points = texel_points(mesh, 4, 4);
  REQUIRE(points.texels.size() == 1);
  CHECK(points.texels[0] == 4 * 2 + 0);
  // The chart's point closest to the centre (.5, 2.5) is its corner, which both faces have.
  CHECK(points.points[0].face == 0);
  CHECK((points.positions[0] - mesh.positions[0]).norm() < 1e-12);
}

/// Two texels, 1 apart, each of area 1.
const TriangleMesh& two_texels() {
  static const TriangleMesh mesh = make_plane(1, 1, 2, 1);
  return mesh;
}

Image two_values(std::vector<float> values) {
  Image image = make_image(2, 1, int(values.size()) / 2);
  image.pixels = std::move(values);
  return image;
}

std::vector<double> value_of(const Image& image, std::size_t point, const Weights& weights) {
  const TexelPoints all = texel_points(two_texels(), 2, 1);
  const Neighbourhood around =
      neighbourhood(all, point, weights.radius, straight_distances(two_texels()));
  return filtered_value(all, around, image, weights);
}

TEST_CASE("the oracle sums two texels as one does by hand", "[oracle]") {
  // Left is the lower face's or the upper one's: look for it.
  const TexelPoints all = texel_points(two_texels(), 2, 1);
  REQUIRE(all.texels.size() == 2);
  const std::size_t left = all.texels[0] == 0 ? 0 : 1, right = 1 - left;
  const Image image = two_values({0.2F, 0.8F});
  const double g = std::exp(-1 / (2 * 0.7 * 0.7)), f = std::exp(-0.36 / (2 * 0.5 * 0.5));
  CHECK(value_of(image, left, {0.7, 1})[0] == Approx((0.2 + 0.8 * g) / (1 + g)));
  CHECK(value_of(image, right, {0.7, 1})[0] == Approx((0.8 + 0.2 * g) / (1 + g)));
  CHECK(value_of(image, left, {0.7, 1, 0.5})[0] == Approx((0.2 + 0.8 * g * f) / (1 + g * f)));
  CHECK(value_of(image, left, {0.7, 0.99})[0] == Approx(0.2));
}

TEST_CASE("the oracle leaves out what is not finite, weighs by alpha and keeps it", "[oracle]") {
  const TexelPoints all = texel_points(two_texels(), 2, 1);
  const std::size_t left = all.texels[0] == 0 ? 0 : 1, right = 1 - left;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // Channels: colour, colour, alpha.
  Image image = two_values({0.2F, 0.4F, 0.1F, 0.8F, nan, 0.9F});
  image.alpha_channel = 2;
  CHECK(value_of(image, left, {0.7, 1})[0] == Approx(0.2));
  CHECK(value_of(image, left, {0.7, 1})[2] == Approx(0.1));
  // What is not finite has the mean of what is.
  CHECK(value_of(image, right, {0.7, 1})[0] == Approx(0.2));
  CHECK(value_of(image, right, {0.7, 1})[1] == Approx(0.4));
  CHECK(value_of(image, right, {0.7, 1, 0.5})[1] == Approx(0.4));
  CHECK(value_of(image, right, {0.7, 1})[2] == Approx(0.9));
  image.pixels = {0.2F, 0.4F, 0.1F, 0.8F, 0.4F, 0};
  CHECK(value_of(image, left, {0.7, 1})[0] == Approx(0.2));
  CHECK(value_of(image, right, {0.7, 1})[0] == Approx(0.8));  // nothing can be seen of it
  image.pixels = {0.2F, 0.4F, 0.1F, 0.8F, 0.4F, 0.3F};
  const double g = std::exp(-1 / (2 * 0.7 * 0.7)), f = std::exp(-0.36 / (2 * 0.5 * 0.5));
  CHECK(value_of(image, left, {0.7, 1, 0.5})[0] ==
        Approx((0.1 * 0.2 + 0.3 * 0.8 * g * f) / (0.1 + 0.3 * g * f)));
  CHECK(value_of(image, left, {0.7, 1, 0.5})[2] == Approx(0.1));
}

TEST_CASE("the oracle takes the mean by area of a texel's places, and sees what is wrong",
          "[oracle]") {
  // Two squares out of each other's reach on one texel, the second twice as wide, and beside them a
  // texel of their neighbourhood each: columns 0 and 1.
  TriangleMesh mesh = two_texels();
  const auto vertices = Index(mesh.positions.size());
  const std::size_t faces = mesh.faces.size();
  for (Index v = 0; v < vertices; ++v)
    mesh.positions.push_back(2 * mesh.positions[v] + Vec3(0, 0, 9));
  for (std::size_t f = 0; f < faces; ++f) {
    const auto corners = mesh.faces[f];
    mesh.faces.push_back({corners[0] + vertices, corners[1] + vertices, corners[2] + vertices});
    mesh.face_uvs.push_back(mesh.face_uvs[f]);
    mesh.face_materials.push_back(kNone);
  }
  const Image image = two_values({0.2F, 0.8F});
  const double near = std::exp(-1 / (2 * 0.7 * 0.7)), far = std::exp(-4 / (2 * 0.7 * 0.7));
  const auto by_hand = [&](double own, double other) {
    const double small = (own + other * near) / (1 + near), large = (own + other * far) / (1 + far);
    return float((small + 4 * large) / 5);
  };
  Image result = two_values({by_hand(0.2, 0.8), by_hand(0.8, 0.2)});
  const Weights weights{0.7, 2.5};
  const DefinitionError right =
      against_definition(mesh, image, result, weights, 20, straight_distances(mesh));
  CHECK(right.psnr > 130);
  CHECK(right.shared == 20);
  result.pixels[1] += 0.01F;
  const DefinitionError wrong =
      against_definition(mesh, image, result, weights, 20, straight_distances(mesh));
  CHECK(wrong.psnr < 60);
  CHECK(wrong.worst == Approx(0.01).epsilon(1e-3));
  result.pixels[1] = std::numeric_limits<float>::quiet_NaN();
  CHECK(std::isinf(
      against_definition(mesh, image, result, weights, 20, straight_distances(mesh)).worst));
}

}  // namespace
}  // namespace onmesh
