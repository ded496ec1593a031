#include "onmesh/procedural/shapes.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "onmesh/base/error.h"
#include "onmesh/measure/mesh_report.h"
#include "support/uv_charts.h"

using namespace onmesh;

namespace {

constexpr double kPi = std::numbers::pi;

struct Named {
  const char* name;
  TriangleMesh mesh;
};

std::vector<Named> closed_shapes() {
  return {{"cube", make_cube(3)},
          {"sphere", make_sphere(2)},
          {"torus", make_torus(12, 8)},
          {"blob", make_blob(2, 7)},
          {"chest", make_chest(2)}};
}

std::vector<Named> open_shapes() {
  return {{"plane", make_plane(3, 2, 2, 1)},
          {"folded sheet", make_folded_sheet(4, 2, 1, 100)},
          {"U-sheet", make_u_sheet(1, 1, 0.05, 3, 2)},
          {"gentle sheet", make_gentle_sheet(5)},
          {"cone", make_cone(270, 9, 3)},
          {"cylinder", make_cylinder(9, 2)},
          {"saddle", make_saddle(4)}};
}

std::vector<Named> all_shapes() {
  std::vector<Named> shapes = closed_shapes();
  for (Named& shape : open_shapes()) shapes.push_back(std::move(shape));
  shapes.push_back({"book", make_book(2)});
  return shapes;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area;
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = mesh.corners(f);
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

// How often every directed edge occurs.
std::map<std::pair<Index, Index>, int> directed_edges(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, int> count;
  for (const auto& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) ++count[{face[k], face[(k + 1) % 3]}];
  }
  return count;
}

// Ratios of edge lengths in space and in UVs (scaled by width and height); all 1 = isometric.
void check_isometric(const TriangleMesh& mesh, double width, double height) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto p = mesh.corners(f);
    const auto uv = mesh.corner_uvs(f);
    for (int k = 0; k < 3; ++k) {
      const Vec2 flat = (uv[(k + 1) % 3] - uv[k]).cwiseProduct(Vec2(width, height));
      CHECK((p[(k + 1) % 3] - p[k]).norm() == Approx(flat.norm()).epsilon(1e-9));
    }
  }
}

}  // namespace

TEST_CASE("the Moebius strip is one-sided, closed, and true to its chart", "[shapes]") {
  for (const int n : {1, 2, 5}) {
    for (const double width : {1.0, 0.3}) {
      const TriangleMesh mesh = make_moebius(n, 8, width);
      const MeshReport r = report_mesh(mesh);
      CHECK_FALSE(r.orientable);
      CHECK(r.nonmanifold_edges + r.nonmanifold_vertices == 0);
      CHECK(r.components == 1);
      CHECK(r.charts == 1);
      CHECK(r.boundary_loops == 1);
      CHECK(r.surface_area == Approx(8 * width));
      CHECK(r.density_min == Approx(kMoebiusScale / 8));
      double worst = 0;
      for (Index f = 0; f < mesh.faces.size(); ++f) {
        const auto p = mesh.corners(f);
        const auto u = mesh.corner_uvs(f);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t l = (k + 1) % 3;
          worst = std::max(
              worst, std::abs((p[l] - p[k]).norm() - (u[l] - u[k]).norm() * 8 / kMoebiusScale));
        }
      }
      CHECK(worst < 1e-13);
    }
  }
  CHECK_THROWS_AS(make_moebius(0), UsageError);
  CHECK_THROWS_AS(make_moebius(1, 8, 1.1), UsageError);
}

TEST_CASE("the bow tie's halves share one vertex and nothing else", "[shapes]") {
  const MeshReport r = report_mesh(make_bow_tie(3));
  CHECK(r.nonmanifold_vertices == 1);
  CHECK(r.nonmanifold_edges == 0);
  CHECK(r.components == 1);
  CHECK(r.charts == 2);
  CHECK(r.surface_area == Approx(2));
  CHECK(r.max_overlap <= 1);
}

TEST_CASE("closed shapes are closed and wound outward", "[shapes]") {
  for (const auto& [name, mesh] : closed_shapes()) {
    INFO(name);
    const auto edges = directed_edges(mesh);
    bool closed = true;
    for (const auto& [edge, count] : edges) {
      const auto opposite = edges.find({edge.second, edge.first});
      closed = closed && count == 1 && opposite != edges.end();
    }
    CHECK(closed);
    CHECK(signed_volume(mesh) > 0);
  }
}

TEST_CASE("Euler characteristics are those of sphere, torus and two boxes", "[shapes]") {
  const auto euler = [](const TriangleMesh& mesh) {
    return long(mesh.positions.size()) - long(directed_edges(mesh).size()) / 2 +
           long(mesh.faces.size());
  };
  CHECK(euler(make_cube(4)) == 2);
  CHECK(euler(make_sphere(3)) == 2);
  CHECK(euler(make_torus(9, 5)) == 0);
  CHECK(euler(make_chest(2)) == 4);
}

TEST_CASE("open shapes have edges of one or two faces, wound alike", "[shapes]") {
  for (const auto& [name, mesh] : open_shapes()) {
    INFO(name);
    bool once = true;
    for (const auto& [edge, count] : directed_edges(mesh)) once = once && count == 1;
    CHECK(once);
  }
}

TEST_CASE("the book's spine is the only edge line with three pages", "[shapes]") {
  const TriangleMesh book = make_book(4);
  std::map<std::pair<Index, Index>, int> faces;
  for (const auto& [edge, count] : directed_edges(book))
    faces[std::minmax(edge.first, edge.second)] += count;
  int spine = 0;
  for (const auto& [edge, count] : faces) {
    if (count != 3) {
      CHECK(count <= 2);
      continue;
    }
    ++spine;
    CHECK(book.positions[edge.first].x() == 0);
    CHECK(book.positions[edge.second].x() == 0);
  }
  CHECK(spine == 4);
}

TEST_CASE("shapes have no unused, repeated or degenerate elements", "[shapes]") {
  for (const auto& [name, mesh] : all_shapes()) {
    INFO(name);
    std::vector<bool> used(mesh.positions.size());
    REQUIRE(mesh.face_uvs.size() == mesh.faces.size());
    REQUIRE(mesh.face_materials.size() == mesh.faces.size());
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (const Index v : mesh.faces[f]) used.at(v) = true;
      const auto [a, b, c] = mesh.corners(f);
      CHECK((b - a).cross(c - a).norm() > 1e-9);
      CHECK(uv_area(mesh.corner_uvs(f)) > 1e-9);  // not mirrored either
    }
    CHECK(std::find(used.begin(), used.end(), false) == used.end());
    std::set<std::array<double, 3>> positions;
    for (const Vec3& p : mesh.positions) positions.insert({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0});
    CHECK(positions.size() == mesh.positions.size());
  }
}

TEST_CASE("charts neither overlap nor come closer than four texels at 256 x 256", "[shapes]") {
  constexpr int kSize = 256;
  for (const auto& [name, mesh] : all_shapes()) {
    INFO(name);
    const std::vector<Index> chart_of = uv_charts(mesh).numbers;
    std::vector<Index> owner(kSize * kSize, kNone);  // the chart of the texel's centre
    double total = 0;
    long centres = 0;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const auto uv = mesh.corner_uvs(f);
      total += uv_area(uv);
      Eigen::Matrix2d edges;
      edges << uv[1] - uv[0], uv[2] - uv[0];
      const Eigen::Matrix2d inverse = edges.inverse();
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          const Vec2 b = inverse * (Vec2((x + 0.5) / kSize, (y + 0.5) / kSize) - uv[0]);
          if (b.minCoeff() < 0 || b.sum() > 1) continue;
          Index& texel = owner[y * kSize + x];
          CHECK((texel == kNone || texel == chart_of[f]));
          centres += texel == kNone;
          texel = chart_of[f];
        }
      }
    }
    // Within a chart overlaps would show as UV area without texels.
    CHECK(double(centres) == Approx(total * kSize * kSize).epsilon(0.01));
    int too_close = 0;
    for (int y = 3; y < kSize - 3; ++y) {
      for (int x = 3; x < kSize - 3; ++x) {
        const Index chart = owner[y * kSize + x];
        if (chart == kNone) continue;
        for (int dy = -3; dy <= 3; ++dy) {
          for (int dx = -3; dx <= 3; ++dx) {
            const Index other = owner[(y + dy) * kSize + x + dx];
            if (other != kNone && other != chart && dx * dx + dy * dy <= 9) ++too_close;
          }
        }
      }
    }
    CHECK(too_close == 0);
  }
}

TEST_CASE("the number of charts is as documented", "[shapes]") {
  const std::map<std::string, Index> expected{
      {"cube", 6},     {"sphere", 20},      {"torus", 1},   {"blob", 20},        {"chest", 12},
      {"plane", 1},    {"folded sheet", 1}, {"U-sheet", 1}, {"gentle sheet", 1}, {"cone", 1},
      {"cylinder", 1}, {"saddle", 1},       {"book", 3}};
  for (const auto& [name, mesh] : all_shapes()) {
    INFO(name);
    CHECK(uv_charts(mesh).count == expected.at(name));
  }
}

TEST_CASE("developable shapes are isometric to their charts", "[shapes]") {
  check_isometric(make_plane(3, 2, 2, 1), 2, 1);
  check_isometric(make_folded_sheet(5, 2, 1, 120, 2), 2, 1);
  check_isometric(make_u_sheet(1, 0.5, 0.1, 4, 3), u_sheet_width(1, 0.1, 4), 0.5);
  check_isometric(make_cube(2), 64.0 / 7, 64.0 / 7);
  const double margins = 1 - 2 * kChartMargin;
  const double around = cylinder_circumference(7, 1.5);
  check_isometric(make_cylinder(7, 3, 1.5, 2), around / margins, around / margins);
  // A sector of 270 degrees is 2 wide if its ridges reach both ends of the diameter.
  check_isometric(make_cone(270, 12, 4), 2 / margins, 2 / margins);
  check_isometric(make_book(2), 3 / (1 - 4 * kChartMargin), 3 / (1 - 4 * kChartMargin));
}

TEST_CASE("the cone is closed around its axis and its apex lacks the missing sector", "[shapes]") {
  const TriangleMesh cone = make_cone(200, 10, 2);
  double angle = 0;
  int faces = 0;
  for (Index f = 0; f < cone.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (cone.positions[cone.faces[f][k]].norm() > 0) continue;
      const auto p = cone.corners(f);
      angle += std::acos(p[(k + 1) % 3].normalized().dot(p[(k + 2) % 3].normalized()));
      ++faces;
    }
  }
  CHECK(faces == 10);
  CHECK(angle == Approx(200 * kPi / 180));
  CHECK(cone.positions.size() == 1 + 2 * 10);
}

TEST_CASE("areas are those of the ideal shapes", "[shapes]") {
  CHECK(surface_area(make_cube(3)) == Approx(24));
  CHECK(surface_area(make_folded_sheet(3, 2, 1, 90)) == Approx(2));
  CHECK(surface_area(make_book(3)) == Approx(3 * 1.4));
  CHECK(surface_area(make_chest()) ==
        Approx(2 * (2 * 1 + 2 * 1.4 + 1 * 1.4) + 2 * (2 * 0.4 + 2 * 1.4 + 0.4 * 1.4)));
  // Curved ones converge quadratically.
  const double coarse = 4 * kPi - surface_area(make_sphere(3)),
               fine = 4 * kPi - surface_area(make_sphere(4));
  CHECK(coarse / fine == Approx(4).epsilon(0.05));
  const double torus = 4 * kPi * kPi * 0.4;
  CHECK((torus - surface_area(make_torus(40, 20))) / (torus - surface_area(make_torus(80, 40))) ==
        Approx(4).epsilon(0.05));
}

TEST_CASE("the leaves of the U-sheet are parallel, the gap apart and over each other", "[shapes]") {
  const TriangleMesh sheet = make_u_sheet(1, 1, 0.01, 4, 1);
  Vec3 low = sheet.positions[0], high = low;
  for (const Vec3& p : sheet.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  CHECK(low.z() == 0);
  CHECK(high.z() == Approx(0.01));
  int at_start = 0;
  for (const Vec3& p : sheet.positions) at_start += p.x() == 0;
  CHECK(at_start == 4);  // both ends
}

TEST_CASE("a blob is the sphere when its amplitude is zero, and depends on its seed", "[shapes]") {
  const TriangleMesh sphere = make_sphere(2), flat = make_blob(2, 5, 0), a = make_blob(2, 5),
                     b = make_blob(2, 6);
  double difference = 0;
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    CHECK(flat.positions[i] == sphere.positions[i]);
    CHECK(std::abs(a.positions[i].norm() - 1) <= 0.45 + 1e-12);
    difference = std::max(difference, (a.positions[i] - b.positions[i]).norm());
  }
  CHECK(difference > 0.01);
}

TEST_CASE("shape parameters outside their domain are refused", "[shapes]") {
  CHECK_THROWS_AS(make_plane(0, 1), UsageError);
  CHECK_THROWS_AS(make_plane(1, 1, -1), UsageError);
  CHECK_THROWS_AS(make_plane(1, 1, std::nan("")), UsageError);
  CHECK_THROWS_AS(make_cone(360, 8, 1), UsageError);
  CHECK_THROWS_AS(make_cylinder(2, 1), UsageError);
  CHECK_THROWS_AS(make_torus(8, 8, 1, 1), UsageError);
  CHECK_THROWS_AS(make_sphere(9), UsageError);
  CHECK_THROWS_AS(make_folded_sheet(2, 1, 1, 180), UsageError);
}
