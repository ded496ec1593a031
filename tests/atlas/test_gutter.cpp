#include "onmesh/atlas/gutter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "onmesh/measure/seam_error.h"
#include "onmesh/procedural/shapes.h"
#include "support/atlas_meshes.h"
#include "support/cut_meshes.h"
#include "support/images.h"
#include "support/rewritten_meshes.h"

using namespace onmesh;

namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();

double linear(const Vec3& p) { return 0.3 + 0.4 * p.x() + 0.2 * p.y() - 0.1 * p.z(); }

}  // namespace

TEST_CASE("a linear texture goes on linearly over the seams of a flat mesh", "[gutter]") {
  for (const Index n : {2U, 6U, 20U}) {
    const TriangleMesh mesh = halves(n);
    const TexelMap map = make_texel_map(mesh, 90, 80);
    REQUIRE(map.charts == 2);
    Image image = paint(mesh, map, linear, kNaN);
    const auto filled = fill_gutter(mesh, map, 4, image);
    // The charts' affine maps, from any of their faces.
    std::array<Index, 2> face_of{};
    for (Index f = 0; f < mesh.faces.size(); ++f) face_of[map.chart_of_face[f]] = f;
    int over_seam = 0;
    for (const Index texel : filled) {
      const Vec3 centre(texel % 90 + 0.5, texel / 90 + 0.5, 1);
      REQUIRE(std::isfinite(*image.texel(texel)));
      // The nearer chart's continuation counts.
      std::array<double, 2> distance{1e9, 1e9};
      for (Index f = 0; f < mesh.faces.size(); ++f) {
        const auto uv = mesh.corner_uvs(f);
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec2 a(uv[k].x() * 90, (1 - uv[k].y()) * 80);
          const Vec2 b = Vec2(uv[(k + 1) % 3].x() * 90, (1 - uv[(k + 1) % 3].y()) * 80) - a;
          const Vec2 c = centre.head<2>() - a;
          const double t = std::clamp(c.dot(b) / b.squaredNorm(), 0.0, 1.0);
          double& d = distance[map.chart_of_face[f]];
          d = std::min(d, (c - t * b).norm());
        }
      }
      if (std::abs(distance[0] - distance[1]) < 1e-6) continue;
      const Index f = face_of[distance[1] < distance[0]];
      const Vec3 b = map.to_barycentric(f) * centre;
      const auto p = mesh.corners(f);
      const Vec3 at = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
      const bool own = map.chart_of_face[f] == map.chart_of_face[0];
      const double beyond = own ? at.x() - 0.5 : 0.5 - at.x();
      if (beyond < 0 || at.y() < 0 || at.y() > 1) continue;  // the surface ends there
      ++over_seam;
      INFO("texel " << texel % 90 << ", " << texel / 90 << " with n = " << n);
      REQUIRE(std::abs(*image.texel(texel) - linear(at)) < 2e-6);
    }
    CHECK(over_seam > 200);
    const SeamError error = seam_error(mesh, map, image);
    CHECK(error.edges == n);
    CHECK(error.rms < 2e-3);  // not 0: the cut ends where the surface ends
  }
}

TEST_CASE("a piece cut out of a flat sheet leaves no seam in a linear texture", "[gutter]") {
  const TriangleMesh sheet = make_plane(6, 6);
  const auto piece = [](Index f) {
    const Index x = f / 2 % 6, y = f / 12;
    return int(x >= 2 && x < 4 && y >= 1 && y < 4);
  };
  const TriangleMesh mesh = cut(sheet, piece, [](int g, const Vec2& uv) {
    if (g == 0) return Vec2(0.05 + 0.6 * uv.x(), 0.05 + 0.9 * uv.y());
    const Vec2 d = 0.4 * (uv - Vec2(0.5, 0.4));
    return Vec2(0.83 + std::cos(1.1) * d.x() + std::sin(1.1) * d.y(),  // mirrored, too
                0.5 + std::sin(1.1) * d.x() - std::cos(1.1) * d.y());
  });
  for (const int size : {60, 101, 256}) {
    const TexelMap map = make_texel_map(mesh, size, size);
    REQUIRE(map.charts == 2);
    Image image = paint(mesh, map, linear, 0);
    CHECK(seam_error(mesh, map, image).max > 0.1);
    fill_gutter(mesh, map, 2, image);
    const SeamError error = seam_error(mesh, map, image);
    CHECK(error.edges == 10);
    CHECK(error.max < 2e-6);
  }
}

TEST_CASE("the gutter is the same however the mesh is wound, numbered and divided", "[gutter]") {
  const auto waves = [](const Vec3& p) { return std::sin(11 * p.x() + 17 * p.y() - 14 * p.z()); };
  // Beyond the corners of charts lie cones, where the two ways around lead to different places.
  for (const TriangleMesh& mesh : {turned_cube(1), turned_cube(3), make_blob(1, 1)}) {
    const int size = 123;
    Image image = paint(mesh, make_texel_map(mesh, size, size), waves, 0);
    const Image before = image;
    fill_gutter(mesh, make_texel_map(mesh, size, size), 3, image);
    for (const auto& rewrite : std::vector<void (*)(TriangleMesh&)>{
             reverse_winding, split_at_barycentres, [](TriangleMesh& m) { turn_corners(m, 1); },
             [](TriangleMesh& m) { renumber_vertices(m, 2); }}) {
      TriangleMesh same = mesh;
      rewrite(same);
      Image filled = before;
      fill_gutter(same, make_texel_map(same, size, size), 3, filled);
      CHECK(largest_difference(filled, image) < 1e-5);
    }
  }
}

TEST_CASE("an edge of the texture just beyond a seam is not drawn onto a coarser chart",
          "[gutter]") {
  // The right half has five times as many texels per length; it is black from 0.4 of the left
  // half's texels on. The left half is white.
  const TriangleMesh mesh = cut(
      make_plane(2, 2), [](Index f) { return int(f / 2 % 2); },
      [](int g, const Vec2& uv) {
        return g == 0 ? Vec2(0.02 + 0.2 * uv.x(), 0.02 + 0.2 * uv.y())
                      : Vec2(0.4 + (uv.x() - 0.5), 0.02 + 0.96 * uv.y());
      });
  const int size = 200;
  const TexelMap map = make_texel_map(mesh, size, size);
  REQUIRE(map.charts == 2);
  const double edge = 0.5 + 0.4 / (0.2 * size);
  Image image = paint(
      mesh, map, [&](const Vec3& p) { return p.x() < edge ? 1.0 : 0.0; }, 0);
  fill_gutter(mesh, map, 2, image);
  CHECK(seam_error(mesh, map, image).max < 1e-5);
  // On the finer chart's side nothing is hidden: its gutter shows the white half.
  const std::vector<Index> filled = fill_gutter(mesh, map, 2, image);
  std::size_t white = 0;
  for (const Index texel : filled) white += *image.texel(texel) == 1;
  CHECK(white > 100);
}

TEST_CASE("a constant texture stays constant to the bit", "[gutter]") {
  for (const float value : {0.1F, 0.7F, -3.3F}) {
    for (const TriangleMesh& mesh : {halves(6), turned_cube(1), turned_cube(5)}) {
      const TexelMap map = make_texel_map(mesh, 75, 64);
      Image image = paint(
          mesh, map, [&](const Vec3&) { return double(value); }, kNaN);
      const auto filled = fill_gutter(mesh, map, 5, image);
      for (const Index texel : filled) REQUIRE(*image.texel(texel) == value);
    }
  }
}

TEST_CASE("just touched texels and rings are filled, nothing else changes", "[gutter]") {
  const TriangleMesh mesh = halves(4);
  const int width = 61, height = 53;
  const TexelMap map = make_texel_map(mesh, width, height);
  for (const int rings : {0, 1, 2, 5}) {
    Image image = paint(mesh, map, linear, -7);
    const Image before = image;
    const auto filled = fill_gutter(mesh, map, rings, image);
    CHECK(std::is_sorted(filled.begin(), filled.end()));
    const std::set<Index> set(filled.begin(), filled.end());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Index at = Index(y * width + x);
        bool near = false;
        for (int v = y - rings; v <= y + rings; ++v)
          for (int u = x - rings; u <= x + rings; ++u)
            near = near || map.coverage[map.tiles[0].texel({u, v})] != Coverage::none;
        const bool expected = near && map.coverage[at] != Coverage::covered;
        REQUIRE((set.count(at) == 1) == expected);
        if (expected)
          REQUIRE(*image.texel(at) != -7);
        else
          REQUIRE(*image.texel(at) == *before.texel(at));
      }
  }
}

TEST_CASE("look-ups anywhere on charts see only covered and filled texels", "[gutter]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const TriangleMesh& mesh : {halves(6), turned_cube(1), turned_cube(7)}) {
    const TexelMap map = make_texel_map(mesh, 40, 50);
    Image image = paint(mesh, map, linear, kNaN);
    fill_gutter(mesh, map, 1, image);
    for (int i = 0; i < 20000; ++i) {
      const auto uv = mesh.corner_uvs(Index(random() % mesh.faces.size()));
      double r = unit(random), s = i % 2 ? unit(random) : 0;  // half of them on edges
      if (r + s > 1) r = 1 - r, s = 1 - s;
      float value = 0;
      bilinear(image, map.tiles[0].wrap, uv[0] + r * (uv[1] - uv[0]) + s * (uv[2] - uv[0]), &value);
      REQUIRE(std::isfinite(value));
    }
  }
}

TEST_CASE("seams of a cube's smooth texture close as texels shrink", "[gutter]") {
  const TriangleMesh mesh = turned_cube(3);
  double last = 1;
  for (const int size : {60, 120, 240}) {
    const TexelMap map = make_texel_map(mesh, size, size);
    const auto wave = [](const Vec3& p) { return std::sin(3 * p.x() + 2 * p.y() - 4 * p.z()); };
    Image image = paint(mesh, map, wave, 0);
    const double before = seam_error(mesh, map, image).rms;
    fill_gutter(mesh, map, 2, image);
    const SeamError error = seam_error(mesh, map, image);
    CHECK(error.edges == 36);
    CHECK(error.rms < 0.16 * before * 60 / size);
    CHECK(error.rms < 0.52 * last);
    last = error.rms;
  }
  CHECK(last < 0.007);  // first order: the texture has a kink at every edge
}

TEST_CASE("over a bridged gap the texture goes on as if there were none", "[gutter][bridge]") {
  constexpr double kGap = 1e-4;
  const TriangleMesh whole = halves(6);
  TriangleMesh parted = whole;  // right of x = 1/2 with vertices of its own
  const auto vertices = Index(whole.positions.size());
  for (const Vec3& p : whole.positions) parted.positions.push_back(p + Vec3(kGap, 0, 0));
  for (Index f = 0; f < parted.faces.size(); ++f) {
    const auto c = whole.corners(f);
    if (c[0].x() + c[1].x() + c[2].x() < 1.5) continue;
    for (Index& v : parted.faces[f]) v += vertices;
  }
  parted = weld(parted);
  const auto filled = [](const TriangleMesh& mesh, double bridge) {
    const TexelMap map = make_texel_map(mesh, 90, 80);
    Image image = paint(mesh, map, linear, 0);
    fill_gutter(mesh, map, 4, image, bridge);
    return image;
  };
  const Image expected = filled(whole, 0);
  CHECK(largest_difference(filled(parted, 2 * kGap), expected) < 2 * kGap);
  CHECK(largest_difference(filled(parted, 0), expected) > 0.005F);
  CHECK(largest_difference(filled(parted, kGap / 2), expected) > 0.005F);
}

TEST_CASE("the nearer of two charts fills the texels between them", "[gutter]") {
  // Two squares that are not connected, columns 2 to 7 and 12 to 17 of 20.
  TriangleMesh mesh = flat({{0.1, 0.1},
                            {0.4, 0.1},
                            {0.4, 0.9},
                            {0.1, 0.9},
                            {0.6, 0.1},
                            {0.9, 0.1},
                            {0.9, 0.9},
                            {0.6, 0.9}},
                           {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
  const TexelMap map = make_texel_map(mesh, 20, 20);
  Image image = paint(
      mesh, map, [](const Vec3& p) { return p.x() < 0.5 ? 1 : 2; }, 0);
  fill_gutter(mesh, map, 3, image);
  for (Index x = 8; x < 12; ++x) CHECK(*image.texel(10 * 20 + x) == (x < 10 ? 1 : 2));
  CHECK(*image.texel(10 * 20 + 1) == 1);
  CHECK(*image.texel(10 * 20 + 19) == 2);
}

TEST_CASE("rings wrap around a repeated image and stop at a clamped one", "[gutter]") {
  const TriangleMesh mesh =
      flat({{0, 0.3}, {0.5, 0.3}, {0.5, 0.7}, {0, 0.7}}, {{0, 1, 2}, {0, 2, 3}});
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
    const TexelMap map = make_texel_map(mesh, 10, 10, {wrap, {}});
    Image image = paint(
        mesh, map, [](const Vec3&) { return 1; }, 0);
    fill_gutter(mesh, map, 1, image);
    CHECK(*image.texel(5 * 10 + 9) == (wrap == Wrap::repeat ? 1 : 0));
    CHECK(*image.texel(5 * 10 + 5) == 1);
  }
}

TEST_CASE("a chart over the image's border fills its gutter on both sides", "[gutter]") {
  TriangleMesh mesh = halves(4);
  for (Vec2& uv : mesh.uvs) uv += Vec2(5.3, -2.45);
  const TexelMap map = make_texel_map(mesh, 64, 64);
  Image image = paint(mesh, map, linear, kNaN);
  const auto filled = fill_gutter(mesh, map, 2, image);
  for (const Index texel : filled) REQUIRE(std::isfinite(*image.texel(texel)));
  CHECK(seam_error(mesh, map, image).rms < 4e-3);
}

TEST_CASE("alpha is left alone and values that are not finite do not spread", "[gutter]") {
  const TriangleMesh mesh = halves(4);
  const TexelMap map = make_texel_map(mesh, 50, 50);
  Image image = make_image(50, 50, 2);
  image.alpha_channel = 1;
  for (Index i = 0; i < 2500; ++i) {
    image.texel(i)[0] = map.coverage[i] == Coverage::covered && i % 7 ? 0.5F : kNaN;
    image.texel(i)[1] = 0.25F;
  }
  for (const Index texel : fill_gutter(mesh, map, 3, image)) {
    REQUIRE(image.texel(texel)[0] == 0.5F);
    REQUIRE(image.texel(texel)[1] == 0.25F);
  }
}

TEST_CASE("charts thinner than a texel are extended from what they have", "[gutter]") {
  // A strip without any centre, and a needle.
  const TriangleMesh mesh = flat(
      {{0.1, 0.3}, {0.9, 0.3}, {0.9, 0.302}, {0.1, 0.302}, {0.1, 0.6}, {0.1, 0.62}, {0.93, 0.61}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}});
  const TexelMap map = make_texel_map(mesh, 40, 40);
  Image image = paint(
      mesh, map, [](const Vec3& p) { return p.y() < 0.5 ? 1 : 2; }, 0);
  const auto filled = fill_gutter(mesh, map, 2, image);
  CHECK(filled.size() > 200);
  for (const Index texel : filled) REQUIRE(*image.texel(texel) == (texel / 40 > 20 ? 1 : 2));
}

TEST_CASE("without faces there is nothing to fill", "[gutter]") {
  TriangleMesh mesh = make_plane(1, 1);
  mesh.face_uvs.assign(2, {kNone, kNone, kNone});
  const TexelMap map = make_texel_map(mesh, 5, 5);
  Image image = make_image(5, 5, 3);
  CHECK(fill_gutter(mesh, map, 3, image).empty());
}

TEST_CASE("seams of real meshes close", "[gutter][data][slow]") {
  struct Case {
    const char* name;
    int size;
    double share;  ///< of the seam error before filling; what is left is charts too close together
  };
  for (const Case& c : {Case{"spot/cow.obj", 1024, 0.05}, Case{"bob/bob_tri.obj", 1024, 0.03},
                        Case{"pizza_scan/pizza.obj", 2048, 0.08}}) {
    const TriangleMesh mesh = read_data(c.name);
    if (mesh.faces.empty()) continue;
    INFO(c.name);
    const TexelMap map = make_texel_map(mesh, c.size, c.size);
    const auto wave = [](const Vec3& p) {
      return std::sin(9 * p.x()) * std::cos(7 * p.y()) + p.z();
    };
    Image image = paint(mesh, map, wave, 0);
    const SeamError before = seam_error(mesh, map, image);
    const auto filled = fill_gutter(mesh, map, 2, image);
    const SeamError after = seam_error(mesh, map, image);
    CHECK(before.edges > 0);
    INFO("before " << before.rms << ", after " << after.rms << ", max " << after.max);
    CHECK(after.rms < c.share * before.rms);
    // What is filled lies between values of the surface.
    float low = std::numeric_limits<float>::max(), high = -low;
    for (Index texel = 0; texel < map.coverage.size(); ++texel)
      if (map.coverage[texel] == Coverage::covered) {
        low = std::min(low, *image.texel(texel));
        high = std::max(high, *image.texel(texel));
      }
    CHECK(filled.size() > map.coverage.size() / 200);
    for (const Index texel : filled) {
      REQUIRE(*image.texel(texel) >= low - 1e-6F);
      REQUIRE(*image.texel(texel) <= high + 1e-6F);
    }
  }
}
