// Which face claims which texel, against brute force.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/atlas/texel_map.h"
#include "support/texel_claims.h"

using namespace onmesh;

namespace {

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

/// Whether a triangle has area: faces without UV area take no part.
bool has_area(const std::vector<Vec2>& t) {
  const Vec2 a = t[1] - t[0], b = t[2] - t[0];
  return std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-9;
}

/// Claims and coverage of a mesh whose charts do not overlap, texel by texel.
void check_against_brute_force(const TriangleMesh& mesh, const TexelMap& map) {
  std::vector<Index> owner(map.coverage.size(), kNone);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index i = map.face_offsets[f]; i < map.face_offsets[f + 1]; ++i) {
      REQUIRE(owner[map.tiles[0].texel(map.claims[i])] == kNone);
      owner[map.tiles[0].texel(map.claims[i])] = f;
    }
  for (int y = 0; y < map.tiles[0].height; ++y)
    for (int x = 0; x < map.tiles[0].width; ++x) {
      Index expected = kNone;
      bool meets = false;
      for (Index f = 0; f < mesh.faces.size(); ++f) {
        const auto t = pixel_corners(mesh, f, map.tiles[0].width, map.tiles[0].height);
        if (!has_area(t)) continue;
        if (expected == kNone && holds_point(t, {x + 0.5, y + 0.5}, 1e-10)) expected = f;
        meets = meets || meets_square(t, x, y);
      }
      const auto at = std::size_t(y * map.tiles[0].width + x);
      INFO("texel " << x << ", " << y);
      REQUIRE(owner[at] == expected);
      const Coverage coverage = expected != kNone ? Coverage::covered
                                : meets           ? Coverage::touched
                                                  : Coverage::none;
      REQUIRE(int(map.coverage[at]) == int(coverage));
    }
}

}  // namespace

TEST_CASE("two triangles over the image claim every texel once", "[claim_texels]") {
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
          "[claim_texels]") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const int size = seed % 2 ? 24 : 31;
    const TriangleMesh mesh = random_square(seed, 150, seed % 3 == 0 ? 0 : size);
    const TexelMap map = make_texel_map(mesh, size, size);
    INFO("seed " << seed);
    CHECK(map.claims.size() == std::size_t(size * size));
    check_against_brute_force(mesh, map);
  }
}

TEST_CASE("a rotated, jittered chart claims and touches what brute force finds", "[claim_texels]") {
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

TEST_CASE("a fan around a vertex on a texel centre gives it to one face", "[claim_texels]") {
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
  const auto is_centre = [&](const TexelClaim& claim) { return map.tiles[0].texel(claim) == 44; };
  CHECK(std::any_of(map.claims.begin(), map.claims.begin() + map.face_offsets[1], is_centre));
}

TEST_CASE("faces without UV area neither claim nor open gaps nor double claims", "[claim_texels]") {
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

TEST_CASE("repeated UVs claim wrapped texels", "[claim_texels]") {
  TriangleMesh mesh = square();
  for (Vec2& uv : mesh.uvs) uv = Vec2(3 * uv.x() - 1.25, uv.y() - 7.5);
  const TexelMap map = make_texel_map(mesh, 20, 16);
  CHECK(map.claims.size() == 3 * 20 * 16);
  for (const int n : claim_counts(map)) REQUIRE(n == 3);
  CHECK(map.overlapped().size() == 20 * 16);
  CHECK(claimed_area(map) == Approx(1).epsilon(1e-12));
  CHECK(map.tiles[0].texel({-1, -1}) == 20 * 16 - 1);
  CHECK(map.tiles[0].texel({-20, 16}) == 0);
  const TexelMap clamped = make_texel_map(mesh, 20, 16, {Wrap::clamp, {}});
  CHECK(clamped.claims.empty());
}

TEST_CASE("clamped UVs claim only texels of the image", "[claim_texels]") {
  TriangleMesh mesh = square();
  for (Vec2& uv : mesh.uvs) uv = 2 * uv - Vec2(0.5, 0.5);
  const TexelMap map = make_texel_map(mesh, 20, 20, {Wrap::clamp, {}});
  CHECK(map.claims.size() == 400);
  for (const int n : claim_counts(map)) REQUIRE(n == 1);
}

TEST_CASE("a long thin face over many tiles touches each of its texels once around",
          "[claim_texels]") {
  const TriangleMesh mesh = flat({{0, 0.53}, {300, 0.53}, {300, 0.54}}, {{0, 1, 2}});
  const TexelMap map = make_texel_map(mesh, 16, 16);
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      CHECK((map.coverage[std::size_t(y * 16 + x)] != Coverage::none) == (y == 7));
}

TEST_CASE("charts that lie on each other claim texels once each", "[claim_texels]") {
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

TEST_CASE("a chart folded onto itself claims twice inside and once on the fold", "[claim_texels]") {
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

TEST_CASE("seams separate charts, shared UVs of other positions too", "[claim_texels]") {
  TriangleMesh mesh = square();
  mesh.uvs.push_back(mesh.uvs[2]);
  mesh.face_uvs[1][1] = 4;  // the same UV value by another index on one end of the diagonal
  const TexelMap map = make_texel_map(mesh, 10, 10);
  CHECK(map.charts == 2);
  CHECK(map.overlapped().empty());  // the diagonal's centres lie on both charts, which only touch
}

TEST_CASE("a chart without any centre claims the texel it overlaps most", "[claim_texels]") {
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

TEST_CASE("charts that end on texel borders touch nothing beyond them", "[claim_texels]") {
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
