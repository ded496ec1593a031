#include "onmesh/mesh/clean.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/small_meshes.h"

using namespace onmesh;

namespace {

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

TEST_CASE("cleaning drops collapsed and repeated faces and says which are left", "[clean]") {
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {8, 8, 8}},
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

TEST_CASE("winding follows the larger area of each component, UVs move along", "[clean]") {
  for (unsigned turned = 0; turned < 16; ++turned) {
    TriangleMesh mesh = corner_tetrahedron();
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
  const TriangleMesh one = corner_tetrahedron();
  TriangleMesh two = one;
  for (const Vec3& p : one.positions) two.positions.push_back(p + Vec3(5, 0, 0));
  for (const auto& f : one.faces) two.faces.push_back({f[1] + 4, f[0] + 4, f[2] + 4});
  two.face_uvs.assign(8, {kNone, kNone, kNone});
  two.face_materials.assign(8, kNone);
  std::swap(two.faces[2][0], two.faces[2][1]);
  two.normals = two.positions;  // every corner's tells which vertex it was
  two.face_normals = two.faces;
  CleanReport report;
  const TriangleMesh cleaned = clean(two, &report);
  CHECK(report.flipped == 1);
  REQUIRE(cleaned.face_normals.size() == 8);
  for (Index f = 0; f < 8; ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(cleaned.normals[cleaned.face_normals[f][k]] == cleaned.corners(f)[k]);
  }
}

TEST_CASE("faces that read one texture differently are different layers", "[clean]") {
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}});
  mesh.uvs = {{0, 0}, {2, 0}, {0, 2}};
  mesh.face_uvs = mesh.faces;
  mesh.materials = {{"a", "t.png"}, {"b", "t.png"}};
  mesh.face_materials = {0, 1};
  CHECK(clean(mesh).faces.size() == 1);
  mesh.materials[1].wrap = Wrap::clamp;
  CHECK(clean(mesh).faces.size() == 2);
}

TEST_CASE("a one-sided component is left as it is, the others are wound", "[clean]") {
  TriangleMesh strip = bare_mesh({}, {});
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

TEST_CASE("a small fin is dropped, a flag on a pole is not", "[clean]") {
  for (const double size : {0.001, 0.5}) {
    std::vector<Vec3> positions = corner_tetrahedron().positions;
    positions[2].y() = 0.0005;  // so that the fin's edge is short, too
    positions.emplace_back(-size, 0, 0);
    auto faces = corner_tetrahedron().faces;
    faces.push_back({0, 2, 4});
    faces.push_back({2, 0, 4});
    CleanReport report;
    const TriangleMesh cleaned = clean(bare_mesh(positions, faces), &report);
    const bool small = size < 0.01;
    CHECK(report.fins == (small ? 2 : 0));
    CHECK(report.duplicates == (small ? 0 : 1));
    CHECK(cleaned.faces.size() == (small ? 4 : 5));
  }
  // Two copies that run the same way, and a lone pair, keep one face.
  CleanReport report;
  clean(bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {90, 0, 0}, {90, 9, 0}, {0, 99, 0}},
                  {{0, 1, 2}, {2, 1, 0}, {3, 4, 5}}),
        &report);
  CHECK(report.fins == 0);
  CHECK(report.duplicates == 1);
}

TEST_CASE("layers are parted also where a face without texels comes first", "[clean]") {
  TriangleMesh mesh =
      bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}});
  mesh.uvs = {{0, 0}, {0.4, 0}, {0, 0.4}, {0.5, 0.5}, {0.9, 0.5}, {0.5, 0.9}};
  mesh.face_uvs = {{kNone, kNone, kNone}, {0, 1, 2}, {3, 4, 5}};
  CleanReport report;
  const TriangleMesh cleaned = clean(mesh, &report);
  CHECK(report.kept == std::vector<Index>{1, 2});
  CHECK(report.duplicates == 1);
  CHECK(report.separated > 0);
  CHECK(cleaned.positions.size() == 6);
}
