#include "onmesh/mesh/triangle_mesh.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"

using namespace onmesh;
using Face = std::array<Index, 3>;

namespace {

TriangleMesh make(std::vector<Vec3> positions, std::vector<Face> faces) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  mesh.face_uvs.assign(mesh.faces.size(), {kNone, kNone, kNone});
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

const std::vector<Vec3> kTetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Face> kOutward = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto c = mesh.corners(f);
    sum += (c[0].x() * (c[1].y() * c[2].z() - c[1].z() * c[2].y()) +
            c[0].y() * (c[1].z() * c[2].x() - c[1].x() * c[2].z()) +
            c[0].z() * (c[1].x() * c[2].y() - c[1].y() * c[2].x())) /
           6;
  }
  return sum;
}

}  // namespace

TEST_CASE("a surface point interpolates position and UV", "[triangle_mesh]") {
  TriangleMesh mesh = make({{0, 0, 0}, {2, 0, 0}, {0, 2, 4}}, {{0, 1, 2}});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.face_uvs = {{2, 1, 0}};
  CHECK(mesh.position({0, {0.25, 0.25, 0.5}}).isApprox(Vec3(0.5, 1, 2)));
  CHECK(mesh.uv({0, {0.25, 0.25, 0.5}}).isApprox(Vec2(0.25, 0.25)));
  CHECK(mesh.face_area(0) == Approx(std::sqrt(20.0)));
}

TEST_CASE("edges count once and unused vertices not at all", "[triangle_mesh]") {
  const TriangleMesh square =
      make({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{1, 2, 3}, {1, 3, 4}});
  CHECK(square.mean_edge_length() == Approx((4 + std::sqrt(2.0)) / 5));
  CHECK(square.diagonal() == Approx(std::sqrt(2.0)));
  CHECK(make({}, {}).mean_edge_length() == 0);
  CHECK(make({}, {}).diagonal() == 0);
}

TEST_CASE("welding joins what is equal bit by bit, and only that", "[triangle_mesh]") {
  const double next = std::nextafter(1.0, 2.0);
  TriangleMesh mesh =
      make({{7, 7, 7}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -0.0, 0}, {0, 1, 0}, {next, 1, 0}},
           {{1, 2, 3}, {5, 4, 6}});
  mesh.uvs = {{5, 5}, {0, 0}, {1, 0}, {-0.0, 0}};
  mesh.face_uvs = {{1, 2, kNone}, {3, 2, 2}};
  const TriangleMesh welded = weld(mesh);
  CHECK(welded.positions.size() == 4);
  CHECK(welded.faces == std::vector<Face>{{0, 1, 2}, {2, 1, 3}});
  CHECK(welded.uvs.size() == 2);
  CHECK(welded.face_uvs == std::vector<Face>{{0, 1, kNone}, {0, 1, 1}});
  const TriangleMesh again = weld(welded);
  CHECK(again.positions == welded.positions);
  CHECK(again.faces == welded.faces);
  CHECK(again.uvs == welded.uvs);
  CHECK(again.face_uvs == welded.face_uvs);
}

TEST_CASE("a mesh of loose triangles welds to the mesh it was cut from", "[triangle_mesh]") {
  constexpr Index n = 30;
  TriangleMesh loose = make({}, {});
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const auto at = [](Index x, Index y) {
        return Vec3(x * 0.1, y / 3.0, std::sin(x + 2.0 * y));
      };
      for (const auto& corner :
           {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)}) {
        loose.positions.push_back(corner);
      }
    }
  }
  for (Index f = 0; f < 2 * n * n; ++f) {
    loose.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    loose.face_uvs.push_back({kNone, kNone, kNone});
    loose.face_materials.push_back(kNone);
  }
  const TriangleMesh welded = weld(loose);
  CHECK(welded.positions.size() == (n + 1) * (n + 1));
  for (Index f = 0; f < loose.faces.size(); ++f) CHECK(welded.corners(f) == loose.corners(f));
}

TEST_CASE("cleaning drops collapsed and repeated faces and says which are left",
          "[triangle_mesh]") {
  TriangleMesh mesh = make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {8, 8, 8}},
                           {{0, 1, 2}, {0, 0, 4}, {1, 2, 0}, {2, 1, 0}, {0, 3, 1}});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.face_uvs = {{0, 1, 2}, {3, 3, 3}, {1, 2, 0}, {2, 1, 0}, {0, 0, 1}};
  mesh.materials = {{"a", ""}, {"b", ""}};
  mesh.face_materials = {0, 1, 1, 1, 1};
  CleanReport report;
  const TriangleMesh cleaned = clean(mesh, &report);
  CHECK(report.collapsed == 1);
  CHECK(report.duplicates == 2);
  CHECK(report.fins == 0);
  CHECK(report.kept == std::vector<Index>{0, 4});
  // The face without area stays, as it carries connectivity; the far vertex went with its face.
  CHECK(cleaned.faces.size() == 2);
  CHECK(cleaned.positions.size() == 4);
  CHECK(cleaned.uvs.size() == 3);
  CHECK(cleaned.face_materials == std::vector<Index>{0, 1});
}

TEST_CASE("winding follows the larger area of each component, UVs move along", "[triangle_mesh]") {
  for (unsigned turned = 0; turned < 16; ++turned) {
    TriangleMesh mesh = make(kTetrahedron, kOutward);
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    mesh.face_uvs = mesh.faces;
    for (std::size_t f = 0; f < 4; ++f) {
      if (!(turned >> f & 1U)) continue;
      std::swap(mesh.faces[f][0], mesh.faces[f][1]);
      std::swap(mesh.face_uvs[f][0], mesh.face_uvs[f][1]);
    }
    double outward = 0, inward = 0;
    for (Index f = 0; f < 4; ++f) (turned >> f & 1U ? inward : outward) += mesh.face_area(f);
    CleanReport report;
    const TriangleMesh cleaned = clean(mesh, &report);
    CHECK(std::abs(volume(cleaned)) == Approx(1.0 / 6));
    CHECK((volume(cleaned) > 0) == (outward > inward));
    CHECK(cleaned.face_uvs == cleaned.faces);
    if (turned == 1) CHECK(report.flipped == 1);
  }
  // Two components are judged apart.
  TriangleMesh two = make(kTetrahedron, kOutward);
  for (const Vec3& p : kTetrahedron) two.positions.push_back(p + Vec3(5, 0, 0));
  for (const Face& f : kOutward) two.faces.push_back({f[1] + 4, f[0] + 4, f[2] + 4});
  two.face_uvs.assign(8, {kNone, kNone, kNone});
  two.face_materials.assign(8, kNone);
  std::swap(two.faces[2][0], two.faces[2][1]);
  CleanReport report;
  clean(two, &report);
  CHECK(report.flipped == 1);
}

TEST_CASE("a one-sided component is left as it is, the others are wound", "[triangle_mesh]") {
  TriangleMesh strip = make({}, {});
  constexpr Index n = 7;
  for (Index i = 0; i < n; ++i) {
    strip.positions.emplace_back(i, 0, 0);
    strip.positions.emplace_back(i, 1, 0);
  }
  for (Index i = 0; i < n; ++i) {
    Index a = 2 * i, b = a + 1, c = 2 * (i + 1), d = c + 1;
    if (i + 1 == n) c = 1, d = 0;
    strip.faces.push_back({a, c, b});
    strip.faces.push_back({b, c, d});
  }
  strip.face_uvs.assign(2 * n, {kNone, kNone, kNone});
  strip.face_materials.assign(2 * n, kNone);
  // And one square besides whose faces are wound against each other.
  for (const Vec3& p : {Vec3(0, 5, 0), Vec3(1, 5, 0), Vec3(1, 6, 0), Vec3(0, 6, 0)})
    strip.positions.push_back(p);
  strip.faces.push_back({2 * n, 2 * n + 1, 2 * n + 2});
  strip.faces.push_back({2 * n, 2 * n + 3, 2 * n + 2});
  strip.face_uvs.assign(2 * n + 2, {kNone, kNone, kNone});
  strip.face_materials.assign(2 * n + 2, kNone);
  CleanReport report;
  const TriangleMesh cleaned = clean(strip, &report);
  CHECK_FALSE(report.orientable);
  CHECK_FALSE(report.manifold());
  CHECK(report.defects() == "part of it has only one side");
  CHECK(report.flipped == 1);
  for (std::size_t f = 0; f < 2 * n; ++f) CHECK(cleaned.faces[f] == strip.faces[f]);
}

TEST_CASE("a small fin is dropped, a flag on a pole is not", "[triangle_mesh]") {
  for (const double size : {0.001, 0.5}) {
    std::vector<Vec3> positions = kTetrahedron;
    positions[2].y() = 0.0005;  // so that the fin's edge is short, too
    positions.emplace_back(-size, 0, 0);
    std::vector<Face> faces = kOutward;
    faces.push_back({0, 2, 4});
    faces.push_back({2, 0, 4});
    CleanReport report;
    const TriangleMesh cleaned = clean(make(positions, faces), &report);
    const bool small = size < 0.01;
    CHECK(report.fins == (small ? 2 : 0));
    CHECK(report.duplicates == (small ? 0 : 1));
    CHECK(cleaned.faces.size() == (small ? 4 : 5));
  }
  // Two copies that run the same way, and a lone pair, keep one face.
  CleanReport report;
  clean(make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {90, 0, 0}, {90, 9, 0}, {0, 99, 0}},
             {{0, 1, 2}, {2, 1, 0}, {3, 4, 5}}),
        &report);
  CHECK(report.fins == 0);
  CHECK(report.duplicates == 1);
}

TEST_CASE("a loosened mesh welds to what it was", "[triangle_mesh]") {
  TriangleMesh mesh = make(kTetrahedron, kOutward);
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.face_uvs = mesh.faces;
  mesh.face_uvs[2][1] = kNone;
  const TriangleMesh loose = loosen(mesh);
  CHECK(loose.positions.size() == 12);
  CHECK(loose.uvs.size() == 11);
  const TriangleMesh welded = weld(loose);
  CHECK(welded.positions.size() == 4);
  CHECK(welded.uvs.size() == 4);
  for (Index f = 0; f < 4; ++f) CHECK(welded.corners(f) == mesh.corners(f));
  CHECK(welded.face_uvs[2][1] == kNone);
}

TEST_CASE("extracted faces keep their corners", "[triangle_mesh]") {
  TriangleMesh mesh = make(kTetrahedron, kOutward);
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.face_uvs = mesh.faces;
  const TriangleMesh part = extract_faces(mesh, {false, false, true, false});
  REQUIRE(part.faces.size() == 1);
  CHECK(part.positions.size() == 3);
  CHECK(part.uvs.size() == 3);
  CHECK(part.corners(0) == mesh.corners(2));
  CHECK(part.corner_uvs(0) == mesh.corner_uvs(2));
}
