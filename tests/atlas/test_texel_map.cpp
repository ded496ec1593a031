#include "onmesh/atlas/texel_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"
#include "support/mesh_parts.h"
#include "support/oracle.h"
#include "support/texel_claims.h"

using namespace onmesh;

namespace {

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    sum += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("faces without UVs or surface area claim nothing", "[texel_map]") {
  TriangleMesh mesh = square();
  mesh.face_uvs[0][1] = kNone;
  CHECK(make_texel_map(mesh, 10, 10).claims.size() == 55);
  mesh = square();
  for (Vec3& p : mesh.positions) p = Vec3(p.x(), 0, 0);
  const TexelMap map = make_texel_map(mesh, 10, 10);
  CHECK(map.claims.empty());
  CHECK(map.charts == 0);
  CHECK(map.median_texel_size() == 0);
  CHECK(make_texel_map(square(), 10, 10, {Wrap::repeat, {false, true}}).claims.size() == 55);
}

TEST_CASE("the claimed area approaches the surface area as texels shrink", "[texel_map]") {
  const TriangleMesh mesh = make_plane(8, 8);
  double last = 1;
  for (const int size : {50, 200, 800}) {
    TriangleMesh bent = mesh;
    for (Vec3& p : bent.positions) p.z() = std::sin(3 * p.x() * p.y());
    for (Vec2& uv : bent.uvs) uv = 0.1 * Vec2::Ones() + 0.77 * uv;
    const double error =
        std::abs(claimed_area(make_texel_map(bent, size, size)) / surface_area(bent) - 1);
    CHECK(error < last);
    last = error;
  }
  CHECK(last < 2e-3);
}

TEST_CASE("barycentric coordinates reproduce the texel's centre", "[texel_map]") {
  const TriangleMesh mesh = random_square(9, 40, 50);
  const TexelMap map = make_texel_map(mesh, 50, 40);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index i = map.face_offsets[f]; i < map.face_offsets[f + 1]; ++i) {
      const Vec3 b = map.barycentric(f, map.claims[i]);
      const auto t = pixel_corners(mesh, f, 50, 40);
      REQUIRE(b.minCoeff() >= 0);
      REQUIRE(std::abs(b.sum() - 1) < 1e-14);
      const Vec2 p = b[0] * t[0] + b[1] * t[1] + b[2] * t[2];
      REQUIRE((p - Vec2(map.claims[i].x + 0.5, map.claims[i].y + 0.5)).norm() < 1e-8);
    }
}

TEST_CASE("faces that span many tiles are rasterised, absurd ones refused", "[texel_map]") {
  TriangleMesh mesh = square();
  for (Vec2& uv : mesh.uvs) uv *= 1000;
  const TexelMap map = make_texel_map(mesh, 4, 2);
  CHECK(map.claims.size() == 8000000);
  for (const int n : claim_counts(map)) REQUIRE(n == 1000000);
  for (Vec2& uv : mesh.uvs) uv *= 10;
  CHECK_THROWS_AS(make_texel_map(mesh, 256, 256), InputError);
  for (Vec2& uv : mesh.uvs) uv *= 2;
  CHECK_THROWS_WITH(make_texel_map(mesh, 4, 4), Catch::Contains("face 0"));
  for (Vec2& uv : mesh.uvs) uv.y() *= 1e-9;
  CHECK_THROWS_AS(make_texel_map(mesh, 4, 4), InputError);
  mesh = square();
  mesh.uvs[2].x() = std::nan("");
  CHECK_THROWS_AS(make_texel_map(mesh, 4, 4), InputError);
}

TEST_CASE("the median texel size weighs faces by their texels", "[texel_map]") {
  // Three quarters of the texels lie on a part stretched by 4 in one direction.
  TriangleMesh mesh = flat({{0, 0}, {0.75, 0}, {1, 0}, {0, 1}, {0.75, 1}, {1, 1}},
                           {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}});
  for (Vec3& p : mesh.positions) p.x() = p.x() <= 0.75 ? 4 * p.x() : 3 + (p.x() - 0.75);
  CHECK(make_texel_map(mesh, 100, 100).median_texel_size() == Approx(0.02));
}

TEST_CASE("real atlases are covered once per chart", "[texel_map][data][slow]") {
  struct Case {
    const char* name;
    int width, height;
    bool shared;  ///< whether all texels are claimed more than once, or none
    double area;  ///< the claimed area is that near to the surface's
  };
  for (const Case& c : {Case{"spot/cow.obj", 1024, 1024, false, 0.01},
                        Case{"pizza_scan/pizza.obj", 4096, 4096, false, 0.01},
                        Case{"bob/bob_tri.obj", 2048, 2048, false, 0.01},
                        Case{"box_textured/box_textured.obj", 256, 256, true, 1e-6}}) {
    const TriangleMesh mesh = read_data(c.name);
    if (mesh.faces.empty()) continue;
    INFO(c.name);
    const TexelMap map = make_texel_map(mesh, c.width, c.height);
    const auto covered = std::count(map.coverage.begin(), map.coverage.end(), Coverage::covered);
    CHECK(std::ptrdiff_t(map.overlapped().size()) == (c.shared ? covered : 0));
    CHECK(claimed_area(map) == Approx(surface_area(mesh)).epsilon(c.area));
    std::vector<bool> has(map.charts, false);
    for (Index f = 0; f < mesh.faces.size(); ++f)
      if (map.face_offsets[f + 1] > map.face_offsets[f]) has[map.chart_of_face[f]] = true;
    CHECK(std::count(has.begin(), has.end(), false) == 0);
  }
}

TEST_CASE("a real atlas of repeated textures is claimed as by the definition",
          "[texel_map][data]") {
  const TriangleMesh mesh = read_data("spider/spider.obj");
  if (mesh.faces.empty()) return;
  const TexelMap map = make_texel_map(mesh, 250, 250);
  const TexelPoints own = texel_points(mesh, 250, 250);
  REQUIRE(map.claims.size() == own.points.size());
  for (Index f = 0, i = 0; f < mesh.faces.size(); ++f)
    for (; i < map.face_offsets[f + 1]; ++i) {
      REQUIRE(own.points[i].face == f);
      REQUIRE(own.texels[i] == map.tiles[0].texel(map.claims[i]));
    }
}

TEST_CASE("a UV beyond the image falls on the repeated or on the nearest texel", "[texel_map]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const TexelMap repeated = make_texel_map(mesh, 10, 5);
  const TexelMap clamped = make_texel_map(mesh, 10, 5, {Wrap::clamp, {}});
  for (const TexelMap* map : {&repeated, &clamped}) {
    CHECK(map->tiles[0].texel_at({0.25, 0.9}) == 2);
    CHECK(map->tiles[0].texel_at({0.25, 0.1}) == 42);
  }
  CHECK(repeated.tiles[0].texel_at({1.25, -0.1}) == 2);
  CHECK(clamped.tiles[0].texel_at({1.25, -0.1}) == 49);
}

TEST_CASE("texels are crowded where charts leave no free texel between them", "[texel_map]") {
  // Two charts of 4 x 8 texels in a row, a number of texels apart.
  for (const int gap : {0, 1}) {
    TriangleMesh mesh = make_plane(1, 1, 4, 8), other = mesh;
    const auto place = [&](Vec2 uv, double x) { return Vec2((x + 4 * uv.x()) / 16, uv.y()); };
    for (Vec2& uv : mesh.uvs) uv = place(uv, 1);
    for (Vec2& uv : other.uvs) uv = place(uv, 5 + gap);
    mesh = side_by_side(mesh, other, {10, 0, 0});
    const std::vector<Index> crowded = make_texel_map(mesh, 16, 8).crowded();
    std::vector<Index> expected;
    for (Index row = 0; row < 8 && gap == 0; ++row) {
      expected.push_back(16 * row + 4);
      expected.push_back(16 * row + 5);
    }
    CHECK(crowded == expected);
  }
}
