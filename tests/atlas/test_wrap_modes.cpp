// Texels of faces that leave [0,1], counted place by place.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "onmesh/atlas/gutter_texels.h"
#include "onmesh/atlas/texel_map.h"
#include "support/atlas_meshes.h"

namespace onmesh {
namespace {

/// The column or row that is seen at i, by turning i back into the image step by step.
int seen_at(Wrap wrap, int i, int n) {
  if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
  while (i < 0 || i >= n) {
    if (wrap == Wrap::repeat)
      i += i < 0 ? n : -n;
    else
      i = i < 0 ? -1 - i : 2 * n - 1 - i;
  }
  return i;
}

bool is_cut_off(Wrap wrap, int i, int n) { return wrap == Wrap::clamp && (i < 0 || i >= n); }

/// How often each texel's centre lies in a face. No centre lies on an edge.
std::vector<int> count_places(const TriangleMesh& mesh, int width, int height) {
  std::vector<int> counts(std::size_t(width * height), 0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const WrapModes wrap = mesh.wrap_of(f, Wrap::repeat);
    auto uv = mesh.corner_uvs(f);
    for (Vec2& c : uv) c = Vec2(c.x() * width, (1 - c.y()) * height);
    const auto side = [&](int k, const Vec2& p) {
      const Vec2 a = uv[std::size_t(k)], d = uv[std::size_t(k + 1) % 3] - a, e = p - a;
      return d.x() * e.y() - d.y() * e.x() > 0;
    };
    for (int y = -4 * height; y < 5 * height; ++y)
      for (int x = -4 * width; x < 5 * width; ++x) {
        const Vec2 centre(x + 0.5, y + 0.5);
        if (side(0, centre) != side(1, centre) || side(1, centre) != side(2, centre)) continue;
        if (is_cut_off(wrap.u, x, width) || is_cut_off(wrap.v, y, height)) continue;
        ++counts[std::size_t(seen_at(wrap.v, y, height) * width + seen_at(wrap.u, x, width))];
      }
  }
  return counts;
}

std::vector<int> count_claims(const TexelMap& map) {
  std::vector<int> counts(map.coverage.size(), 0);
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f)
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k)
      ++counts[map.tile_of(f).texel(map.claims[k])];
  return counts;
}

void check_counts(const TriangleMesh& mesh, int width, int height) {
  const TexelMap map = make_texel_map(mesh, width, height);
  const std::vector<int> places = count_places(mesh, width, height);
  CHECK(count_claims(map) == places);
  std::vector<Index> shared;
  for (std::size_t t = 0; t < places.size(); ++t) {
    REQUIRE((map.coverage[t] == Coverage::covered) == (places[t] > 0));
    if (places[t] > 1) shared.push_back(Index(t));
  }
  CHECK(map.overlapped() == shared);
}

/// A quadrangle over several periods, of one material.
TriangleMesh wide_sheet(WrapModes wrap) {
  TriangleMesh mesh =
      flat({{-1.7123, 0.2345}, {1.9345, -1.2345}, {2.3456, 1.1111}, {0.1234, 2.0777}},
           {{0, 1, 2}, {0, 2, 3}});
  mesh.materials = {{"m", {}, wrap}};
  mesh.face_materials.assign(2, 0);
  return mesh;
}

constexpr Wrap kModes[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

TEST_CASE("every pair of wrap modes claims the texels whose centres are seen", "[wrap_modes]") {
  for (const Wrap u : kModes)
    for (const Wrap v : kModes) {
      INFO(int(u) << ' ' << int(v));
      check_counts(wide_sheet({u, v}), 13, 9);
      check_counts(wide_sheet({u, v}), 1, 8);
    }
}

TEST_CASE("faces of one image are claimed in their own modes", "[wrap_modes]") {
  // Each in rows of its own, so that no texel is shared by two charts.
  TriangleMesh mesh = flat({{-0.7123, 0.05},
                            {1.6345, 0.06},
                            {1.3456, 0.2777},
                            {-0.6123, 0.35},
                            {1.5345, 0.36},
                            {1.7456, 0.5777},
                            {-1.5123, 0.65},
                            {1.2345, 0.66},
                            {1.3456, 0.8777},
                            {-0.1123, 0.93},
                            {0.9345, 0.94},
                            {1.0456, 0.9777}},
                           {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}});
  mesh.materials = {{"a", {}, Wrap::clamp}, {"b", {}, Wrap::mirror}, {"c", {}, Wrap::repeat}};
  mesh.face_materials = {0, 1, 2, kNone};
  check_counts(mesh, 40, 60);
  const TexelMap map = make_texel_map(mesh, 40, 60, {Wrap::clamp, {}});
  CHECK(map.tile_of(0).wrap == Wrap::clamp);
  CHECK(map.tile_of(1).wrap == Wrap::mirror);
  CHECK(map.tile_of(2).wrap == Wrap::repeat);
  CHECK(map.tile_of(3).wrap == Wrap::clamp);
}

TEST_CASE("a tile whose faces all agree has their modes", "[wrap_modes]") {
  const TexelMap map = make_texel_map(wide_sheet(Wrap::mirror), 13, 9);
  CHECK(map.tiles[0].wrap == Wrap::mirror);
  CHECK(map.face_wraps.empty());
}

TEST_CASE("charts that touch at a mirrored border settle their texels as on one sheet",
          "[wrap_modes]") {
  // Two charts side by side in the period to the right, which is turned over, and the same in the
  // image itself: the texels between them go to the same chart.
  const auto charts = [](bool is_turned) {
    std::vector<Vec2> uvs = {{0.1, 0.1},   {0.43, 0.1}, {0.41, 0.9}, {0.1, 0.9},
                             {0.425, 0.1}, {0.9, 0.1},  {0.9, 0.9},  {0.405, 0.9}};
    if (is_turned) {
      for (std::size_t i = 4; i < 8; ++i) uvs[i].x() = 2 - uvs[i].x();
    }
    TriangleMesh mesh = flat(uvs, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
    mesh.materials = {{"m", {}, Wrap::mirror}};
    mesh.face_materials.assign(4, 0);
    return mesh;
  };
  const TexelMap plain = make_texel_map(charts(false), 20, 20);
  const TexelMap turned = make_texel_map(charts(true), 20, 20);
  REQUIRE(plain.overlapped().empty());
  CHECK(turned.overlapped().empty());
  const auto owners = [](const TexelMap& map) {
    std::vector<Index> chart(map.coverage.size(), kNone);
    for (Index f = 0; f + 1 < map.face_offsets.size(); ++f)
      for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k)
        chart[map.tile_of(f).texel(map.claims[k])] = map.chart_of_face[f];
    return chart;
  };
  CHECK(owners(turned) == owners(plain));
}

TEST_CASE("a gutter texel finds the nearest edge among all its places", "[wrap_modes]") {
  const int width = 31, height = 23, rings = 2;
  for (const Wrap u : kModes)
    for (const Wrap v : kModes) {
      INFO(int(u) << ' ' << int(v));
      TriangleMesh mesh = flat({{0.7123, 0.2345}, {1.2345, 0.1345}, {1.1456, 1.2111}}, {{0, 1, 2}});
      mesh.materials = {{"m", {}, WrapModes(u, v)}};
      mesh.face_materials = {0};
      const TexelMap map = make_texel_map(mesh, width, height);
      int grown = 0;
      const std::vector<Index> gutter = gutter_texels(map, rings, &grown);
      const std::vector<NearestEdge> nearest = nearest_edges(mesh, map, grown, gutter);
      const double reach = std::sqrt(0.5) * (1 + 2 * grown);
      for (std::size_t i = 0; i < gutter.size(); ++i) {
        double least = 1e300;
        for (int y = -2 * height; y < 3 * height; ++y)
          for (int x = -2 * width; x < 3 * width; ++x) {
            if (is_cut_off(u, x, width) || is_cut_off(v, y, height)) continue;
            if (seen_at(v, y, height) * width + seen_at(u, x, width) != int(gutter[i])) continue;
            for (int k = 0; k < 3; ++k) {
              const auto pixel = [&](int corner) {
                const Vec2 uv = mesh.corner_uvs(0)[std::size_t(corner % 3)];
                return Vec2(uv.x() * width, (1 - uv.y()) * height);
              };
              const Vec2 a = pixel(k), d = pixel(k + 1) - a, p(x + 0.5, y + 0.5);
              const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
              least = std::min(least, (p - a - t * d).squaredNorm());
            }
          }
        if (least > reach * reach) continue;
        REQUIRE(nearest[i].face == 0);
        REQUIRE(nearest[i].squared_distance == Approx(least).margin(1e-9));
        REQUIRE(map.tile_of(0).texel(nearest[i].texel) == gutter[i]);
      }
    }
}

TEST_CASE("UVs repeat a texture by no more than what is not cut off", "[wrap_modes]") {
  const std::array<Vec2, 3> uv = {Vec2(-1, 0), Vec2(5, 0), Vec2(5, 4)};
  CHECK(repeated_area(uv, Wrap::repeat) == Approx(12));
  CHECK(repeated_area(uv, Wrap::mirror) == Approx(12));
  CHECK(repeated_area(uv, Wrap::clamp) == 0);
  CHECK(repeated_area(uv, {Wrap::clamp, Wrap::repeat}) == Approx(4));
  CHECK(repeated_area(uv, {Wrap::mirror, Wrap::clamp}) == Approx(6));
}

}  // namespace
}  // namespace onmesh
