#include "onmesh/atlas/uv_overlap.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/mesh_parts.h"

using namespace onmesh;

TEST_CASE("neighbours never overlap, wherever their edges run", "[uv_overlap]") {
  for (const double angle : {0.0, 0.1, 0.7853981633974483, 1.0}) {
    for (const double scale : {1.0 / 1024, 0.37, 0.5}) {
      TriangleMesh mesh = textured_square(16);
      const Vec2 x(std::cos(angle), std::sin(angle)), y(-x.y(), x.x());
      for (Vec2& uv : mesh.uvs) uv = scale * (uv.x() * x + uv.y() * y) + Vec2(0.4999, 3.25);
      const UvOverlap overlap = estimate_overlap(mesh);
      INFO(angle << " " << scale);
      CHECK(overlap.share == 0);
      CHECK(overlap.deepest <= 1);
    }
  }
}

TEST_CASE("overlap is measured through wrapping, per texture", "[uv_overlap]") {
  TriangleMesh mesh = textured_square(4, {0.5, 0.5});
  mesh = side_by_side(mesh, textured_square(4, {0.5, 0.5}, {0.25, 0}), {2, 0, 0});
  CHECK(estimate_overlap(mesh).share == Approx(1.0 / 3).margin(0.01));
  CHECK(estimate_overlap(mesh).deepest == 2);
  // The same place in other tiles, mirrored: still the same texels.
  for (std::size_t i = mesh.uvs.size() / 2; i < mesh.uvs.size(); ++i) {
    mesh.uvs[i] = Vec2(7.5 - (mesh.uvs[i].x() - 0.25), mesh.uvs[i].y() - 3);
  }
  CHECK(estimate_overlap(mesh).share == 1);
  CHECK(estimate_overlap(textured_square(1, {3, 2})).deepest == 6);
  CHECK(estimate_overlap(textured_square(1, {3, 2})).share == 1);
  // Different textures have different texels; materials without one share whatever is chosen.
  mesh.materials = {{"a", "a.png"}, {"b", "b.png"}};
  for (Index f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials[f] = f < mesh.faces.size() / 2 ? 0 : 1;
  CHECK(estimate_overlap(mesh).share == 0);
  mesh.materials[0].texture = mesh.materials[1].texture = "";
  CHECK(estimate_overlap(mesh).share == 1);
}
