#include "onmesh/measure/seam_error.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/atlas_meshes.h"

using namespace onmesh;

namespace {

/// Two triangles that share a mesh edge (the square's diagonal) and have charts of their own: the
/// second's UVs are moved by `offset`.
TriangleMesh cut_square(const Vec2& offset) {
  TriangleMesh mesh =
      flat({{0.1, 0.1}, {0.4, 0.1}, {0.4, 0.4}, {0.1, 0.4}}, {{0, 1, 2}, {0, 2, 3}});
  for (const Index i : {0, 2, 3}) mesh.uvs.push_back(mesh.uvs[i] + offset);
  mesh.face_uvs[1] = {4, 5, 6};
  return mesh;
}

}  // namespace

TEST_CASE("a seam of equal pictures has no error, a step its height", "[seam_error]") {
  const Vec2 offset(0.5, 0.5);
  const TriangleMesh mesh = cut_square(offset);
  const TexelMap map = make_texel_map(mesh, 40, 40);
  Image image = make_image(40, 40, 2);
  for (Index i = 0; i < 1600; ++i) {
    // The picture repeats at the offset of the second chart.
    image.texel(i)[0] = float(std::sin(i % 40 % 20) * std::cos(i / 40 % 20));
    image.texel(i)[1] = 0.25F;
  }
  SeamError error = seam_error(mesh, map, image);
  CHECK(error.edges == 1);
  CHECK(error.length == Approx(0.3 * std::sqrt(2)));
  CHECK(error.max < 1e-6);
  for (Index i = 0; i < 1600; ++i)
    if (i % 40 >= 20) image.texel(i)[1] = 0.75F;
  error = seam_error(mesh, map, image);
  CHECK(error.max == Approx(0.5));
  CHECK(error.rms == Approx(0.5 / std::sqrt(2)));
}

TEST_CASE("an uncut mesh has no seams", "[seam_error]") {
  const TriangleMesh mesh = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  const TexelMap map = make_texel_map(mesh, 4, 4);
  const SeamError error = seam_error(mesh, map, make_image(4, 4, 1));
  CHECK(error.edges == 0);
  CHECK(error.length == 0);
  CHECK(error.rms == 0);
}
