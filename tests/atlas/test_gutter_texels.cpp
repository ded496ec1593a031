#include "onmesh/atlas/gutter_texels.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/procedural/shapes.h"
#include "support/cut_meshes.h"

using namespace onmesh;

namespace {

/// Whether a texel within so many columns and rows is one of a chart.
bool near_chart(const TexelMap& map, int x, int y, int rings) {
  for (int v = y - rings; v <= y + rings; ++v)
    for (int u = x - rings; u <= x + rings; ++u) {
      const bool inside = u >= 0 && v >= 0 && u < map.tiles[0].width && v < map.tiles[0].height;
      if (map.tiles[0].wrap == Wrap::clamp && !inside) continue;
      if (map.coverage[map.tiles[0].texel({u, v})] != Coverage::none) return true;
    }
  return false;
}

}  // namespace

TEST_CASE("the gutter is what the rings around charts add to them", "[gutter_texels]") {
  TriangleMesh mesh = halves(4);
  for (Vec2& uv : mesh.uvs) uv.x() -= 0.05;  // over the image's border
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
    for (const int rings : {0, 1, 2, 5}) {
      const TexelMap map = make_texel_map(mesh, 61, 53, {wrap, {}});
      std::vector<Index> expected;
      for (int y = 0; y < map.tiles[0].height; ++y)
        for (int x = 0; x < map.tiles[0].width; ++x) {
          const Index texel = map.tiles[0].texel({x, y});
          if (map.coverage[texel] != Coverage::covered && near_chart(map, x, y, rings))
            expected.push_back(texel);
        }
      CHECK(gutter_texels(map, rings) == expected);
    }
}

TEST_CASE("each gutter texel belongs to the nearest edge of all charts", "[gutter_texels]") {
  const int width = 70, height = 50, rings = 3;
  for (const TriangleMesh& mesh : {halves(4), turned_cube(2)}) {
    // Clamped: else edges beyond the image's border may be the nearest.
    const TexelMap map = make_texel_map(mesh, width, height, {Wrap::clamp, {}});
    const std::vector<Index> gutter = gutter_texels(map, rings);
    const std::vector<NearestEdge> nearest = nearest_edges(mesh, map, rings, gutter);
    REQUIRE(nearest.size() == gutter.size());
    const auto pixel = [&](Index f, int k) {
      const Vec2 uv = mesh.corner_uvs(f)[std::size_t(k % 3)];
      return Vec2(uv.x() * width, (1 - uv.y()) * height);
    };
    for (std::size_t i = 0; i < gutter.size(); ++i) {
      const NearestEdge& found = nearest[i];
      const Vec2 centre(gutter[i] % width + 0.5, double(gutter[i] / width) + 0.5);
      // All edges, inner ones too: no inner edge is nearer than the border around it.
      double least = 1e300;
      for (Index f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
          const Vec2 a = pixel(f, k), d = pixel(f, k + 1) - a;
          const double t = std::clamp((centre - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
          least = std::min(least, (centre - a - t * d).squaredNorm());
        }
      REQUIRE(found.face != kNone);
      REQUIRE(found.squared_distance == Approx(least).margin(1e-9));
      const Vec2 a = pixel(found.face, found.edge), b = pixel(found.face, found.edge + 1);
      REQUIRE((a + found.position * (b - a) - centre).squaredNorm() == Approx(least).margin(1e-9));
    }
  }
}

TEST_CASE("more rings than there is room for cost nothing", "[gutter]") {
  const TriangleMesh mesh = make_cube(4);
  const TexelMap map = make_texel_map(mesh, 64, 64);
  int grown = 0;
  const std::vector<Index> all = gutter_texels(map, 32768, &grown);
  CHECK(grown < 64);
  CHECK(all == gutter_texels(map, grown));
  CHECK(all.size() ==
        std::size_t(std::count_if(map.coverage.begin(), map.coverage.end(),
                                  [](Coverage c) { return c != Coverage::covered; })));
}
