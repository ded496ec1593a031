#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"
#include "support/atlas_meshes.h"

using namespace onmesh;

namespace {

TriangleMesh square() { return flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}); }

/// The unit square in random triangles; if `lattice` > 0 all points are snapped to half cells of a
/// lattice x lattice image, so that many of them hit texel centres and corners.
TriangleMesh random_square(unsigned seed, int splits, int lattice) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<std::array<Index, 3>> faces = {{0, 1, 2}, {0, 2, 3}};
  const auto area = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  for (int i = 0; i < splits; ++i) {
    const std::size_t f = random() % faces.size();
    const auto t = faces[f];
    double r = unit(random), s = unit(random);
    if (r + s > 1) r = 1 - r, s = 1 - s;
    Vec2 p = uvs[t[0]] + r * (uvs[t[1]] - uvs[t[0]]) + s * (uvs[t[2]] - uvs[t[0]]);
    if (lattice > 0) p = (p * 2 * lattice).array().round().matrix() / (2.0 * lattice);
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && area(uvs[t[k]], uvs[t[(k + 1) % 3]], p) > 1e-12;
    if (!inside) continue;
    const auto n = Index(uvs.size());
    uvs.push_back(p);
    faces[f] = {t[0], t[1], n};
    faces.push_back({t[1], t[2], n});
    faces.push_back({t[2], t[0], n});
  }
  std::shuffle(faces.begin(), faces.end(), random);
  return flat(uvs, faces);
}

std::vector<int> claim_counts(const TexelMap& map) {
  std::vector<int> counts(map.coverage.size(), 0);
  for (const auto& claim : map.claims) ++counts[map.texel(claim)];
  return counts;
}

std::vector<Vec2> pixel_corners(const TriangleMesh& mesh, Index face, int width, int height) {
  std::vector<Vec2> corners;
  for (const Vec2& uv : mesh.corner_uvs(face))
    corners.emplace_back(uv.x() * width, (1 - uv.y()) * height);
  return corners;
}

/// Whether a closed triangle, grown by `grow` pixels, holds a point.
bool holds_point(const std::vector<Vec2>& t, const Vec2& p, double grow) {
  const Vec2 a = t[1] - t[0], b = t[2] - t[0];
  const double sign = a.x() * b.y() - a.y() * b.x() > 0 ? 1 : -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 e = t[(k + 1) % 3] - t[k], d = p - t[k];
    if (sign * (e.x() * d.y() - e.y() * d.x()) / e.norm() < -grow) return false;
  }
  return true;
}

/// Separating axes: whether the open square at (x, y) meets the open triangle.
bool meets_square(const std::vector<Vec2>& t, int x, int y) {
  std::vector<Vec2> axes = {{1, 0}, {0, 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 e = t[(k + 1) % 3] - t[k];
    axes.emplace_back(Vec2(-e.y(), e.x()).normalized());
  }
  for (const Vec2& axis : axes) {
    double low = 1e300, high = -1e300, square_low = 1e300, square_high = -1e300;
    for (const Vec2& p : t) {
      low = std::min(low, axis.dot(p));
      high = std::max(high, axis.dot(p));
    }
    for (int i = 0; i < 4; ++i) {
      const double d = axis.dot(Vec2(x + i % 2, y + i / 2));
      square_low = std::min(square_low, d);
      square_high = std::max(square_high, d);
    }
    if (high <= square_low + 1e-9 || square_high <= low + 1e-9) return false;
  }
  return true;
}

/// Claims and coverage of a mesh whose charts do not overlap, texel by texel.
void check_against_brute_force(const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<Index> owner(map.coverage.size(), kNone);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index i = map.face_offsets[f]; i < map.face_offsets[f + 1]; ++i) {
      REQUIRE(owner[map.texel(map.claims[i])] == kNone);
      owner[map.texel(map.claims[i])] = f;
    }
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      Index expected = kNone;
      bool meets = false;
      for (Index f = 0; f < mesh.faces.size(); ++f) {
        if (map.texel_area[f] == 0) continue;
        const auto t = pixel_corners(mesh, f, map.width, map.height);
        if (expected == kNone && holds_point(t, {x + 0.5, y + 0.5}, 1e-10)) expected = f;
        meets = meets || meets_square(t, x, y);
      }
      const auto at = std::size_t(y * map.width + x);
      INFO("texel " << x << ", " << y);
      REQUIRE(owner[at] == expected);
      const Coverage coverage = expected != kNone ? Coverage::covered
                                : meets           ? Coverage::touched
                                                  : Coverage::none;
      REQUIRE(int(map.coverage[at]) == int(coverage));
    }
}

double claimed_area(const TexelMap& map) {
  double sum = 0;
  for (std::size_t f = 0; f < map.texel_area.size(); ++f)
    sum += map.texel_area[f] * (map.face_offsets[f + 1] - map.face_offsets[f]);
  return sum;
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    sum += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("two triangles over the image claim every texel once", "[texel_map]") {
  const TriangleMesh mesh = square();
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{100, 100}, {1, 1}, {97, 97}, {64, 33}, {7, 640}}) {
    const TexelMap map = make_texel_map(mesh, width, height);
    CHECK(map.charts == 1);
    CHECK(map.claims.size() == std::size_t(width) * std::size_t(height));
    CHECK(map.overlapped().empty());
    for (const Coverage c : map.coverage) REQUIRE(c == Coverage::covered);
    CHECK(claimed_area(map) == Approx(1).epsilon(1e-12));
    CHECK(map.median_texel_size() == Approx(1 / std::sqrt(width * height)));
  }
  // The diagonal belongs to the lower face.
  const TexelMap map = make_texel_map(mesh, 100, 100);
  CHECK(map.face_offsets == std::vector<Index>{0, 5050, 10000});
}

TEST_CASE("random triangulations of a square claim every texel once, the lowest face first",
          "[texel_map]") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const int size = seed % 2 ? 24 : 31;
    const TriangleMesh mesh = random_square(seed, 150, seed % 3 == 0 ? 0 : size);
    const TexelMap map = make_texel_map(mesh, size, size);
    INFO("seed " << seed);
    CHECK(map.claims.size() == std::size_t(size * size));
    check_against_brute_force(mesh, map);
  }
}

TEST_CASE("a rotated, jittered chart claims and touches what brute force finds", "[texel_map]") {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    TriangleMesh mesh = random_square(seed, 60, 0);
    const double angle = seed * 0.7;
    for (Vec2& uv : mesh.uvs) {
      const Vec2 d = (uv - Vec2(0.5, 0.5)) * 0.6;
      uv = Vec2(0.5 + std::cos(angle) * d.x() - std::sin(angle) * d.y(),
                0.5 + std::sin(angle) * d.x() + std::cos(angle) * d.y());
      if (seed % 2) uv.x() = 1 - uv.x();  // mirrored
    }
    check_against_brute_force(mesh, make_texel_map(mesh, 40, 27));
  }
}

TEST_CASE("a fan around a vertex on a texel centre gives it to one face", "[texel_map]") {
  std::vector<Vec2> uvs = {{0.45, 0.55}};
  std::vector<std::array<Index, 3>> faces;
  const Index n = 1000;
  for (Index i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    uvs.emplace_back(0.45 + 0.4 * std::cos(a), 0.55 + 0.4 * std::sin(a));
    faces.push_back({0, 1 + (i + 500) % n, 1 + (i + 501) % n});
  }
  const TriangleMesh mesh = flat(uvs, faces);
  const TexelMap map = make_texel_map(mesh, 10, 10);
  CHECK(map.overlapped().empty());
  const auto is_centre = [&](const TexelClaim& claim) { return map.texel(claim) == 44; };
  CHECK(std::any_of(map.claims.begin(), map.claims.begin() + map.face_offsets[1], is_centre));
}

TEST_CASE("faces without UV area neither claim nor open gaps nor double claims", "[texel_map]") {
  // A T-junction stitched with a needle along the row of centres v = .5.
  const TriangleMesh mesh = flat({{0, 0.5}, {1, 0.5}, {0.5, 0.5}, {0.5, 0}, {0.5, 1}},
                                 {{0, 2, 1}, {3, 1, 2}, {0, 3, 2}, {0, 1, 4}, {4, 4, 0}});
  const TexelMap map = make_texel_map(mesh, 11, 11);
  CHECK(map.charts == 1);
  CHECK(map.texel_area[0] == 0);
  CHECK(map.texel_area[4] == 0);
  CHECK(map.chart_of_face[0] == kNone);
  CHECK(map.overlapped().empty());
  for (int x = 0; x < 11; ++x) CHECK(map.coverage[std::size_t(5 * 11 + x)] == Coverage::covered);
}

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
  const Index n = 8;
  std::vector<Vec2> uvs;
  std::vector<std::array<Index, 3>> faces;
  for (Index y = 0; y <= n; ++y)
    for (Index x = 0; x <= n; ++x) {
      uvs.emplace_back(x / double(n), y / double(n));
      const Index i = y * (n + 1) + x;
      if (x == n || y == n) continue;
      faces.push_back({i, i + 1, i + n + 2});
      faces.push_back({i, i + n + 2, i + n + 1});
    }
  const TriangleMesh mesh = flat(uvs, faces);
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

TEST_CASE("repeated UVs claim wrapped texels", "[texel_map]") {
  TriangleMesh mesh = square();
  for (Vec2& uv : mesh.uvs) uv = Vec2(3 * uv.x() - 1.25, uv.y() - 7.5);
  const TexelMap map = make_texel_map(mesh, 20, 16);
  CHECK(map.claims.size() == 3 * 20 * 16);
  for (const int n : claim_counts(map)) REQUIRE(n == 3);
  CHECK(map.overlapped().size() == 20 * 16);
  CHECK(claimed_area(map) == Approx(1).epsilon(1e-12));
  CHECK(map.texel({-1, -1}) == 20 * 16 - 1);
  CHECK(map.texel({-20, 16}) == 0);
  const TexelMap clamped = make_texel_map(mesh, 20, 16, {Wrap::clamp, {}});
  CHECK(clamped.claims.empty());
}

TEST_CASE("clamped UVs claim only texels of the image", "[texel_map]") {
  TriangleMesh mesh = square();
  for (Vec2& uv : mesh.uvs) uv = 2 * uv - Vec2(0.5, 0.5);
  const TexelMap map = make_texel_map(mesh, 20, 20, {Wrap::clamp, {}});
  CHECK(map.claims.size() == 400);
  for (const int n : claim_counts(map)) REQUIRE(n == 1);
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

TEST_CASE("a long thin face over many tiles touches each of its texels once around",
          "[texel_map]") {
  const TriangleMesh mesh = flat({{0, 0.53}, {300, 0.53}, {300, 0.54}}, {{0, 1, 2}});
  const TexelMap map = make_texel_map(mesh, 16, 16);
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      CHECK((map.coverage[std::size_t(y * 16 + x)] != Coverage::none) == (y == 7));
}

TEST_CASE("charts that lie on each other claim texels once each", "[texel_map]") {
  TriangleMesh mesh;
  for (Index c = 0; c < 6; ++c) {
    const TriangleMesh s = square();
    for (const Vec3& p : s.positions) mesh.positions.emplace_back(p + Vec3(0, 0, c));
    if (c == 0) mesh.uvs = s.uvs;  // welded: one set of UVs for all
    for (const auto& f : s.faces) {
      mesh.faces.push_back({f[0] + 4 * c, f[1] + 4 * c, f[2] + 4 * c});
      mesh.face_uvs.push_back(f);
    }
  }
  const TexelMap map = make_texel_map(mesh, 9, 9);
  CHECK(map.charts == 6);
  for (const int n : claim_counts(map)) REQUIRE(n == 6);
  CHECK(map.overlapped().size() == 81);
}

TEST_CASE("a chart folded onto itself claims twice inside and once on the fold", "[texel_map]") {
  // Two faces on the same side of their shared edge, which runs through a row of centres.
  TriangleMesh mesh = flat({{0.1, 0.5}, {0.9, 0.5}, {0.5, 0.9}}, {{0, 1, 2}, {0, 1, 2}});
  mesh.positions.emplace_back(0.5, 0.1, 0);
  mesh.uvs.push_back(mesh.uvs[2]);
  mesh.faces[1] = mesh.face_uvs[1] = {1, 0, 3};
  const TexelMap map = make_texel_map(mesh, 11, 11);
  CHECK(map.charts == 1);
  const auto counts = claim_counts(map);
  CHECK(counts[5 * 11 + 5] == 1);
  CHECK(counts[4 * 11 + 5] == 2);
}

TEST_CASE("seams separate charts, shared UVs of other positions too", "[texel_map]") {
  TriangleMesh mesh = square();
  mesh.uvs.push_back(mesh.uvs[2]);
  mesh.face_uvs[1][1] = 4;  // the same UV value by another index on one end of the diagonal
  const TexelMap map = make_texel_map(mesh, 10, 10);
  CHECK(map.charts == 2);
  CHECK(map.overlapped().size() == 10);  // the diagonal's centres lie on both charts
}

TEST_CASE("a chart without any centre claims the texel it overlaps most", "[texel_map]") {
  // 16 x 16 texels; a small square of two faces around (5.0, 3.2) in pixels, most of it in (5, 3).
  const auto at = [](double x, double y) { return Vec2(x / 16, 1 - y / 16); };
  TriangleMesh mesh =
      flat({at(4.95, 3.1), at(5.2, 3.1), at(5.2, 3.3), at(4.95, 3.3)}, {{0, 1, 2}, {0, 2, 3}});
  TexelMap map = make_texel_map(mesh, 16, 16);
  REQUIRE(map.claims.size() == 1);
  CHECK(map.claims[0].x == 5);
  CHECK(map.claims[0].y == 3);
  CHECK(map.coverage[3 * 16 + 5] == Coverage::covered);
  CHECK(map.coverage[3 * 16 + 4] == Coverage::touched);
  const Index face = map.face_offsets[1] == 1 ? 0 : 1;
  const Vec3 b = map.barycentric(face, map.claims[0]);
  CHECK(b.minCoeff() >= 0);
  const auto t = pixel_corners(mesh, face, 16, 16);
  CHECK((b[0] * t[0] + b[1] * t[1] + b[2] * t[2] - Vec2(5.2, 3.3)).norm() < 1e-9);

  // A sliver along texel rows that never meets a centre still gets one texel.
  mesh = flat({at(1, 2.9), at(15, 2.9), at(15, 3.2), at(1, 3.2)}, {{0, 1, 2}, {0, 2, 3}});
  map = make_texel_map(mesh, 16, 16);
  CHECK(map.claims.size() == 1);
  CHECK(map.claims[0].y == 3);
}

TEST_CASE("charts that end on texel borders touch nothing beyond them", "[texel_map]") {
  for (const int size : {10, 30, 49, 300}) {
    TriangleMesh mesh = square();
    const int low = size / 3, high = size - size / 7;
    for (Vec2& uv : mesh.uvs)
      uv = Vec2(double(uv.x() > 0 ? high : low) / size, 1 - double(uv.y() > 0 ? low : high) / size);
    const TexelMap map = make_texel_map(mesh, size, size);
    CHECK(map.claims.size() == std::size_t((high - low) * (high - low)));
    CHECK(std::count(map.coverage.begin(), map.coverage.end(), Coverage::touched) == 0);
  }
}

TEST_CASE("the median texel size weighs faces by their texels", "[texel_map]") {
  // Three quarters of the texels lie on a part stretched by 4 in one direction.
  TriangleMesh mesh = flat({{0, 0}, {0.75, 0}, {1, 0}, {0, 1}, {0.75, 1}, {1, 1}},
                           {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}});
  for (Vec3& p : mesh.positions) p.x() = p.x() <= 0.75 ? 4 * p.x() : 3 + (p.x() - 0.75);
  CHECK(make_texel_map(mesh, 100, 100).median_texel_size() == Approx(0.02));
}

TEST_CASE("real atlases are covered once per chart", "[texel_map][data]") {
  struct Case {
    const char* name;
    int width, height;
    double overlap;  ///< at most this share of covered texels
    double area;     ///< the claimed area is that near to the surface's
  };
  for (const Case& c : {Case{"spot/cow.obj", 1024, 1024, 1e-4, 0.01},
                        Case{"pizza_scan/pizza.obj", 4096, 4096, 1e-4, 0.01},
                        Case{"bob/bob_tri.obj", 2048, 2048, 1e-4, 0.01},
                        Case{"box_textured/box_textured.obj", 256, 256, 1, 1e-6}}) {
    const TriangleMesh mesh = read_data(c.name);
    if (mesh.faces.empty()) continue;
    INFO(c.name);
    const TexelMap map = make_texel_map(mesh, c.width, c.height);
    const auto covered = std::count(map.coverage.begin(), map.coverage.end(), Coverage::covered);
    CHECK(double(map.overlapped().size()) <= c.overlap * double(covered));
    CHECK(claimed_area(map) == Approx(surface_area(mesh)).epsilon(c.area));
    std::vector<bool> has(map.charts, false);
    for (Index f = 0; f < mesh.faces.size(); ++f)
      if (map.face_offsets[f + 1] > map.face_offsets[f]) has[map.chart_of_face[f]] = true;
    CHECK(std::count(has.begin(), has.end(), false) == 0);
  }
  const TriangleMesh spider = read_data("spider/spider.obj");
  if (!spider.faces.empty()) {
    const TexelMap map = make_texel_map(spider, 250, 250);
    CHECK(map.claims.size() > 62500);
    for (Index f = 0; f < spider.faces.size(); ++f)
      if (map.texel_area[f] == 0) REQUIRE(map.face_offsets[f] == map.face_offsets[f + 1]);
  }
}

TEST_CASE("a UV beyond the image falls on the repeated or on the nearest texel", "[texel_map]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const TexelMap repeated = make_texel_map(mesh, 10, 5);
  const TexelMap clamped = make_texel_map(mesh, 10, 5, {Wrap::clamp, {}});
  for (const TexelMap* map : {&repeated, &clamped}) {
    CHECK(map->texel_at({0.25, 0.9}) == 2);
    CHECK(map->texel_at({0.25, 0.1}) == 42);
  }
  CHECK(repeated.texel_at({1.25, -0.1}) == 2);
  CHECK(clamped.texel_at({1.25, -0.1}) == 49);
}

TEST_CASE("texels are crowded where charts leave no free texel between them", "[texel_map]") {
  // Two charts of 4 x 8 texels in a row, a number of texels apart.
  for (const int gap : {0, 1}) {
    TriangleMesh mesh = make_plane(1, 1, 4, 8);
    const TriangleMesh other = mesh;
    const auto place = [&](Vec2 uv, double x) { return Vec2((x + 4 * uv.x()) / 16, uv.y()); };
    for (Vec2& uv : mesh.uvs) uv = place(uv, 1);
    for (const Vec2& uv : other.uvs) mesh.uvs.push_back(place(uv, 5 + gap));
    for (const Vec3& p : other.positions) mesh.positions.push_back(p + Vec3(10, 0, 0));
    for (std::size_t f = 0; f < other.faces.size(); ++f) {
      auto face = other.faces[f], uvs = other.face_uvs[f];
      for (int k = 0; k < 3; ++k) {
        face[k] += Index(other.positions.size());
        uvs[k] += Index(other.uvs.size());
      }
      mesh.faces.push_back(face);
      mesh.face_uvs.push_back(uvs);
      mesh.face_materials.push_back(kNone);
    }
    const std::vector<Index> crowded = make_texel_map(mesh, 16, 8).crowded();
    std::vector<Index> expected;
    for (Index row = 0; row < 8 && gap == 0; ++row) {
      expected.push_back(16 * row + 4);
      expected.push_back(16 * row + 5);
    }
    CHECK(crowded == expected);
  }
}
