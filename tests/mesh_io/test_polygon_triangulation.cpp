#include "onmesh/mesh_io/polygon_triangulation.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace onmesh;
using Face = std::array<Index, 3>;

namespace {

/// Signed area of a triangulation in the xy plane, and the smallest of its triangles' areas.
std::pair<double, double> areas(const std::vector<Vec3>& p, const std::vector<Face>& faces) {
  double sum = 0, least = INFINITY;
  for (const Face& f : faces) {
    const Vec3 a = p[f[1]] - p[f[0]], b = p[f[2]] - p[f[0]];
    const double area = (a.x() * b.y() - a.y() * b.x()) / 2;
    sum += area;
    least = std::min(least, area);
  }
  return {sum, least};
}

double polygon_area(const std::vector<Vec3>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("a polygon is covered by its triangles, turned any way", "[polygon_triangulation]") {
  const auto star = [](int n) {
    std::vector<Vec3> p;
    for (int i = 0; i < n; ++i) {
      const double r = i % 2 ? 1 : 0.3, t = 2 * std::numbers::pi * i / n;
      p.emplace_back(r * std::cos(t), r * std::sin(t), 0);
    }
    return p;
  };
  std::vector<Vec3> comb;
  for (int i = 0; i < 20; ++i) comb.emplace_back(i, i % 2 ? 0.1 : 5, 0);
  std::reverse(comb.begin(), comb.end());
  comb.emplace_back(0, -1, 0);
  comb.emplace_back(19, -1, 0);
  const std::vector<std::vector<Vec3>> polygons = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {2, 0, 0}, {.5, .5, 0}, {0, 2, 0}},                      // dart
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},             // corner on a side
      {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}},  // L
      {{0, 0, 0},
       {3, 0, 0},
       {3, 3, 0},
       {0, 3, 0},
       {0, 0, 0},
       {1, 1, 0},
       {1, 2, 0},
       {2, 2, 0},
       {2, 1, 0},
       {1, 1, 0}},  // hole with bridge
      star(10),
      star(200),
      comb};
  for (std::size_t which = 0; which < polygons.size(); ++which) {
    for (std::size_t shift = 0; shift < polygons[which].size();
         shift += 1 + polygons[which].size() / 12) {
      INFO("polygon " << which << " from corner " << shift);
      std::vector<Vec3> p = polygons[which];
      std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(shift), p.end());
      const auto faces = triangulate_polygon(p);
      CHECK(faces.size() == p.size() - 2);
      const auto [sum, least] = areas(p, faces);
      CHECK(sum == Approx(polygon_area(p)));
      CHECK(least > 0);  // with the sum: no overlap, no sliver of none
      // The same polygon standing in another plane, running the other way.
      std::vector<Vec3> standing;
      for (const Vec3& v : p) standing.emplace_back(0.5 * v.x(), -v.x(), v.y());
      CHECK(triangulate_polygon(standing).size() == faces.size());
      std::reverse(p.begin(), p.end());
      const auto [back, most] = areas(p, triangulate_polygon(p));
      CHECK(back == Approx(polygon_area(p)));
    }
  }
}

TEST_CASE("polygons that have no proper triangulation still give n - 2 triangles",
          "[polygon_triangulation]") {
  const std::vector<std::vector<Vec3>> polygons = {
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},                       // crosses itself
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},                       // on a line
      {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},            // a point
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},            // repeated corner
      {{0, 0, 0}, {1e300, 0, 0}, {1e300, 1e300, 0}, {0, 1e300, 1e300}}};  // squares overflow
  for (const auto& p : polygons) {
    const auto faces = triangulate_polygon(p);
    CHECK(faces.size() == p.size() - 2);
    for (const Face& f : faces) CHECK(std::max({f[0], f[1], f[2]}) < p.size());
  }
  CHECK(triangulate_polygon({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST_CASE("spirals and stars of thousands of corners are covered by their triangles",
          "[polygon_triangulation]") {
  const int n = 6000;
  std::vector<Vec3> spiral, star;
  for (int i = 0; i < n; ++i) {
    const int k = i < n / 2 ? i : n - 1 - i;
    const double r = 1 + k * 0.01 + (i < n / 2 ? 0.005 : 0);
    spiral.emplace_back(r * std::cos(k * 0.1), r * std::sin(k * 0.1), 0);
    const double t = 2 * std::numbers::pi * i / n, s = i % 2 ? 1 : 0.3;
    star.emplace_back(s * std::cos(t), s * std::sin(t), 0);
  }
  for (const std::vector<Vec3>& polygon : {spiral, star}) {
    const std::vector<Face> faces = triangulate_polygon(polygon);
    CHECK(faces.size() == polygon.size() - 2);
    const auto [area, least] = areas(polygon, faces);
    CHECK(area == Approx(polygon_area(polygon)));
    CHECK(least > 0);
  }
}

TEST_CASE("a polygon of thousands of corners that crosses itself is still n - 2 triangles",
          "[polygon_triangulation]") {
  const int n = 2000;
  std::vector<Vec3> polygon;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i * (n / 2 - 1) / n;
    polygon.emplace_back(std::cos(t), std::sin(t), 0);
  }
  CHECK(triangulate_polygon(polygon).size() == polygon.size() - 2);
}
