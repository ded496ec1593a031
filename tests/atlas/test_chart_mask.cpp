#include "onmesh/atlas/chart_mask.h"

#include <catch2/catch.hpp>
#include <limits>

#include "onmesh/procedural/shapes.h"

namespace onmesh {

TEST_CASE("a mask of the texture's size says what it says of each texel", "[chart_mask]") {
  const TriangleMesh mesh = make_plane(1, 1);
  const TexelMap map = make_texel_map(mesh, 8, 8);
  Image mask = make_image(8, 8, 2);
  for (Index t = 0; t < 64; ++t) mask.texel(t)[0] = float(t) / 63;
  mask.texel(3)[0] = std::numeric_limits<float>::quiet_NaN();
  mask.texel(4)[0] = -1;
  mask.texel(5)[0] = 7;
  const std::vector<float> values = chart_mask(mesh, map, {&mask});
  REQUIRE(values.size() == 64);
  CHECK(values[3] == 0);
  CHECK(values[4] == 0);
  CHECK(values[5] == 1);
  CHECK(values[40] == mask.texel(40)[0]);
  CHECK(chart_mask(mesh, map, {nullptr}).empty());
}

TEST_CASE("a mask of another size is looked up bilinearly, and not across charts", "[chart_mask]") {
  // Two charts that touch at u = 1/2.
  TriangleMesh mesh = make_plane(1, 1);
  const auto corners = Index(mesh.uvs.size());
  for (Vec2& uv : mesh.uvs) uv.x() /= 2;
  const TriangleMesh left = mesh;
  for (const Vec2& uv : left.uvs) mesh.uvs.emplace_back(uv.x() + 0.5, uv.y());
  const auto vertices = Index(mesh.positions.size());
  for (const Vec3& p : left.positions) mesh.positions.emplace_back(p.x() + 5, p.y(), p.z());
  for (Index f = 0; f < left.faces.size(); ++f) {
    const auto &v = left.faces[f], &u = left.face_uvs[f];
    mesh.faces.push_back({v[0] + vertices, v[1] + vertices, v[2] + vertices});
    mesh.face_uvs.push_back({u[0] + corners, u[1] + corners, u[2] + corners});
    mesh.face_materials.push_back(left.face_materials[f]);
  }
  const TexelMap map = make_texel_map(mesh, 32, 32);
  Image mask = make_image(8, 8, 1);
  for (Index t = 0; t < 64; ++t) mask.pixels[t] = t % 8 < 4 ? 0.F : 0.25F + 0.5F * float(t / 8) / 8;
  const std::vector<float> values = chart_mask(mesh, map, {&mask});
  for (Index t = 0; t < 32 * 32; ++t) {
    const Index x = t % 32, y = t / 32;
    if (x < 16) REQUIRE(values[t] == 0);
    if (x < 16 || y < 2 || y >= 30) continue;
    // Texel centres in those of the mask.
    REQUIRE(values[t] == Approx(0.25 + 0.5 * ((y + 0.5) / 4 - 0.5) / 8).margin(1e-6));
  }
}

}  // namespace onmesh
