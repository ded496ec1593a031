// Who gets the texels of charts that touch.
#include "onmesh/atlas/settle_claims.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "support/texel_claims.h"

namespace onmesh {
namespace {

constexpr int kSize = 32;  // texels

/// A rectangle in pixels of the image, as a chart of its own, `layer` apart from the others.
void add_rectangle(TriangleMesh& mesh, const Vec2& low, const Vec2& high, double layer,
                   double angle = 0) {
  const auto v = Index(mesh.positions.size()), u = Index(mesh.uvs.size());
  const Vec2 centre{kSize / 2.0, kSize / 2.0};
  for (const Vec2& p : {low, Vec2{high.x(), low.y()}, high, Vec2{low.x(), high.y()}}) {
    const Vec2 d = p - centre;
    const Vec2 q = centre + Vec2(std::cos(angle) * d.x() - std::sin(angle) * d.y(),
                                 std::sin(angle) * d.x() + std::cos(angle) * d.y());
    mesh.positions.emplace_back(p.x(), p.y(), layer);
    mesh.uvs.emplace_back(q.x() / kSize, 1 - q.y() / kSize);
  }
  for (const std::array<Index, 3>& corners :
       {std::array<Index, 3>{0, 1, 2}, std::array<Index, 3>{0, 2, 3}}) {
    mesh.faces.push_back({v + corners[0], v + corners[1], v + corners[2]});
    mesh.face_uvs.push_back({u + corners[0], u + corners[1], u + corners[2]});
  }
}

/// Two charts side by side whose common strip is `overlap` wide, ending at column `end` + .5.
TriangleMesh side_by_side(double overlap, double end, double angle) {
  TriangleMesh mesh;
  add_rectangle(mesh, {6, 8}, {end + 0.5, 24}, 0, angle);
  add_rectangle(mesh, {end + 0.5 - overlap, 8}, {26, 24}, 9, angle);
  return mesh;
}

/// Per texel of the image, how many claims it has.
std::vector<int> counts(const TexelMap& map) {
  std::vector<int> result(map.coverage.size(), 0);
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k)
      ++result[map.tiles[0].texel(map.claims[k])];
  }
  return result;
}

Index chart_at(const TexelMap& map, int x, int y) {
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k)
      if (map.claims[k].x == x && map.claims[k].y == y) return map.chart_of_face[f];
  }
  return kNone;
}

TEST_CASE("a texel on the border of two charts is the one's that covers more of it",
          "[settle_claims]") {
  // Column 16 is covered up to .7 of its width by the left chart, and from .4 on by the right one,
  // then up to .8 and from .45 on.
  for (const auto& [left, right, winner] : {std::tuple{0.7, 0.4, 0}, std::tuple{0.8, 0.45, 0},
                                            std::tuple{0.6, 0.2, 1}, std::tuple{0.5, 0.5, 0}}) {
    const TexelMap map = make_texel_map(side_by_side(left - right, 15.5 + left, 0), kSize, kSize);
    INFO("up to " << left << ", from " << right);
    CHECK(map.charts == 2);
    CHECK(map.overlapped().empty());
    CHECK(map.claims.size() == 20 * 16);
    for (int y = 8; y < 24; ++y) REQUIRE(chart_at(map, 16, y) == Index(winner));
    for (int y = 8; y < 24; ++y) REQUIRE(chart_at(map, 15, y) == 0);
    for (int y = 8; y < 24; ++y) REQUIRE(chart_at(map, 17, y) == 1);
  }
}

TEST_CASE("half a texel in common is an overlap", "[settle_claims]") {
  CHECK(make_texel_map(side_by_side(0.49, 16.2, 0), kSize, kSize).overlapped().empty());
  CHECK(make_texel_map(side_by_side(0.52, 16.2, 0), kSize, kSize).overlapped().size() == 16);
  CHECK(make_texel_map(side_by_side(1.2, 16.7, 0), kSize, kSize).overlapped().size() >= 16);
}

TEST_CASE("charts that touch at any angle share no texel and leave none out", "[settle_claims]") {
  std::size_t settled = 0;
  for (int i = 1; i < 40; ++i) {
    const double angle = 0.16 * i;
    const TexelMap touching = make_texel_map(side_by_side(0.3, 16.1, angle), kSize, kSize);
    const TexelMap apart = make_texel_map(side_by_side(0, 16.1, angle), kSize, kSize);
    INFO("angle " << angle);
    CHECK(touching.overlapped().empty());
    CHECK(touching.claims.size() == apart.claims.size());
    const auto a = counts(touching), b = counts(apart);
    for (std::size_t t = 0; t < a.size(); ++t) REQUIRE(a[t] == b[t]);
    // The left chart ends at the same line in both, the right one begins earlier.
    settled += touching.face_offsets[2] != apart.face_offsets[2];
  }
  CHECK(settled > 10);
}

TEST_CASE("charts that lie on each other share the texels on their outline too",
          "[settle_claims]") {
  for (int i = 0; i < 20; ++i) {
    TriangleMesh mesh;
    const double angle = 0.31 * i;
    add_rectangle(mesh, {7.3, 8.1}, {23.9, 23.4}, 0, angle);
    const std::size_t alone = make_texel_map(mesh, kSize, kSize).claims.size();
    add_rectangle(mesh, {7.3, 8.1}, {23.9, 23.4}, 9, angle);
    const TexelMap map = make_texel_map(mesh, kSize, kSize);
    CHECK(map.charts == 2);
    CHECK(map.claims.size() == 2 * alone);
    CHECK(map.overlapped().size() == alone);
  }
}

TEST_CASE("a chart smaller than a texel leaves it to the chart that covers more of it",
          "[settle_claims]") {
  TriangleMesh mesh;
  add_rectangle(mesh, {8, 8}, {15.8, 16}, 0);
  add_rectangle(mesh, {15.8, 9.1}, {16, 9.9}, 9);  // .16 of texel (15, 9), none of its centre
  add_rectangle(mesh, {20.1, 9.1}, {20.3, 9.3}, 18);
  const TexelMap map = make_texel_map(mesh, kSize, kSize);
  CHECK(map.charts == 3);
  CHECK(map.overlapped().empty());
  CHECK(chart_at(map, 15, 9) == 0);
  CHECK(chart_at(map, 20, 9) == 2);
  CHECK(map.claims.size() == 8 * 8 + 1);
}

TEST_CASE("many charts in one texel share it", "[settle_claims]") {
  TriangleMesh mesh;
  for (int i = 0; i < 40; ++i)
    add_rectangle(mesh, {8 + i * 0.02, 8.2}, {8.02 + i * 0.02, 8.4}, 9 * i);
  const TexelMap map = make_texel_map(mesh, kSize, kSize);
  CHECK(map.charts == 40);
  CHECK(map.claims.size() == 40);
  CHECK(map.overlapped() == std::vector<Index>{8 * kSize + 8});
}

TEST_CASE("charts of many faces touch where their outlines do", "[settle_claims]") {
  // Each side is cut into strips of a fifth of a texel across the common border.
  TriangleMesh mesh;
  const auto add_strips = [&](double from, double to, double layer) {
    const auto v = Index(mesh.positions.size());
    for (int i = 0; i <= 80; ++i) {
      for (const double x : {from, to}) {
        const double y = 8 + i * 0.2;
        mesh.positions.emplace_back(x, y, layer);
        mesh.uvs.emplace_back(x / kSize, 1 - y / kSize);
      }
    }
    for (Index i = 0; i < 80; ++i) {
      mesh.faces.push_back({v + 2 * i, v + 2 * i + 1, v + 2 * i + 3});
      mesh.faces.push_back({v + 2 * i, v + 2 * i + 3, v + 2 * i + 2});
    }
  };
  add_strips(6, 16.7, 0);
  add_strips(16.4, 26, 9);
  mesh.face_uvs = mesh.faces;
  const TexelMap map = make_texel_map(mesh, kSize, kSize);
  CHECK(map.charts == 2);
  CHECK(map.overlapped().empty());
  CHECK(map.claims.size() == 20 * 16);
  for (int y = 8; y < 24; ++y) REQUIRE(chart_at(map, 16, y) == 0);
}

}  // namespace
}  // namespace onmesh
