#include "onmesh/mesh/transform_uvs.h"

#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <random>

#include "support/small_meshes.h"

namespace onmesh {
namespace {

using Face = std::array<Index, 3>;

/// Random faces of five materials or none over a few UVs.
TriangleMesh random_mesh() {
  std::mt19937 random(3);
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {});
  for (int i = 0; i < 12; ++i) mesh.uvs.emplace_back(double(random() % 100) / 7, i);
  mesh.materials.resize(5);
  for (int f = 0; f < 60; ++f) {
    Face uvs{};
    for (Index& uv : uvs) uv = random() % 13 == 0 ? kNone : Index(random() % 11);
    add_face(mesh, {0, 1, 2}, uvs);
    const Index material = Index(random() % 6);
    mesh.face_materials.back() = material == 5 ? kNone : material;
  }
  return mesh;
}

TEST_CASE("every corner's UV is mapped as its own material says", "[transform_uvs]") {
  TriangleMesh mesh = random_mesh();
  std::vector<UvTransform> transforms = {
      scale_and_offset({2, 3}, {0.25, -1}), UvTransform::Identity(),
      scale_and_offset({2, 3}, {0.25, -1}), UvTransform::Identity()};
  transforms[3] << 0.6, -0.8, 0.1, 0.8, 0.6, 0.2;  // turned
  mesh.materials[4].wrap = Wrap::mirror;
  const TriangleMesh before = mesh;
  CHECK(transform_uvs(mesh, transforms) == 0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index material = mesh.face_materials[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index uv = before.face_uvs[f][k];
      REQUIRE((mesh.face_uvs[f][k] == kNone) == (uv == kNone));
      if (uv == kNone) continue;
      const Vec2 old = before.uvs[uv];
      const UvTransform t =
          material < 4 ? transforms[material] : UvTransform(UvTransform::Identity());
      REQUIRE(mesh.uvs[mesh.face_uvs[f][k]] == Vec2(t * Vec3(old.x(), old.y(), 1)));
    }
  }
  CHECK(mesh.uvs[11] == before.uvs[11]);  // no face has it
}

TEST_CASE("UVs are split only between materials of different maps or modes", "[transform_uvs]") {
  TriangleMesh mesh = random_mesh();
  mesh.materials[0].wrap = mesh.materials[1].wrap = Wrap::clamp;
  mesh.materials[2].wrap = WrapModes(Wrap::clamp, Wrap::repeat);
  const TriangleMesh before = mesh;
  transform_uvs(mesh, {});
  std::map<Index, int> group_of;  // per UV
  std::map<std::pair<Index, int>, Index> split;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index m = mesh.face_materials[f];
    const int group = m < 2 ? 0 : m == 2 ? 1 : 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index uv = mesh.face_uvs[f][k];
      if (uv == kNone) continue;
      REQUIRE(group_of.try_emplace(uv, group).first->second == group);
      REQUIRE(split.try_emplace({before.face_uvs[f][k], group}, uv).first->second == uv);
    }
  }
  CHECK(mesh.uvs.size() == split.size() + 1);  // and the one that no face has
}

TEST_CASE("where nothing is asked for nothing is changed", "[transform_uvs]") {
  TriangleMesh mesh = random_mesh();
  const TriangleMesh before = mesh;
  CHECK(transform_uvs(mesh, {5, UvTransform::Identity()}) == 0);
  CHECK(mesh.uvs == before.uvs);
  CHECK(mesh.face_uvs == before.face_uvs);
}

TEST_CASE("UVs that are not finite once mapped are missing", "[transform_uvs]") {
  TriangleMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}});
  mesh.uvs = {{0, 0}, {1e300, 1}, {0, 1}};
  mesh.face_uvs = {{0, 1, 2}, {0, 1, 2}};
  mesh.face_materials = {0, kNone};
  mesh.materials.resize(1);
  CHECK(transform_uvs(mesh, {scale_and_offset({1e300, 1}, {0, 0})}) == 1);
  CHECK(mesh.face_uvs[0][1] == kNone);
  CHECK(mesh.face_uvs[0][0] != kNone);
  CHECK(mesh.uv({1, {0, 1, 0}}) == Vec2(1e300, 1));
  for (const Vec2& uv : mesh.uvs) CHECK(uv.allFinite());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(transform_uvs(mesh, {scale_and_offset({nan, 1}, {0, 0})}) == 2);
  CHECK(mesh.face_uvs[0] == Face{kNone, kNone, kNone});
}

}  // namespace
}  // namespace onmesh
