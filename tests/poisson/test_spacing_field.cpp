#include "onmesh/poisson/spacing_field.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/procedural/shapes.h"
#include "support/cut_meshes.h"
#include "support/mesh_parts.h"

using namespace onmesh;

TEST_CASE("the spacing is the disc in a texel, graded towards smaller ones", "[spacing_field]") {
  // Texels of the second square are 5 times as large, so the spacing grows from the shared edge on.
  const TriangleMesh mesh = two_squares(5);
  const SpacingField field(mesh, make_texel_map(mesh, 100, 100));
  const double texel = 1.0 / 50, small = 0.5 * texel / (1 + 1e-3);
  CHECK(field.least() == Approx(small));
  CHECK(field.largest() == Approx(5 * small));
  for (const double x : {0.0, 0.3, 1.0}) CHECK(field.at(0, {x, 0, 0}) == Approx(small));
  for (const double x : {1.0, 1.02, 1.05, 1.09, 1.2, 2.0})
    CHECK(field.at(2, {x, 0, 0}) ==
          Approx(std::min(5 * small, small + SpacingField::kSlope * (x - 1))));
  // Slope and disc on a mesh where everything varies.
  const TriangleMesh blob = make_blob(3, 4, 0.8);
  const TexelMap map = make_texel_map(blob, 128, 128);
  const SpacingField graded(blob, map);
  const auto points = random_points(blob, 300, 5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = blob.position(points[i]);
    const double r = graded.at(points[i].face, p);
    CHECK(r <= 0.5 * std::sqrt(map.texel_area[points[i].face]));
    CHECK(r >= graded.least());
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 q = blob.position(points[j]);
      const double change = std::abs(r - graded.at(points[j].face, q));
      if (change > SpacingField::kSlope * (p - q).norm() * (1 + 1e-9)) FAIL("too steep");
    }
  }
}

TEST_CASE("stretched texels are measured by their narrow side, down to a sixteenth",
          "[spacing_field]") {
  for (const double stretch : {1.0, 4.0, 10.0, 1000.0}) {
    const TriangleMesh mesh = make_plane(1, 1, 1, stretch);
    const SpacingField field(mesh, make_texel_map(mesh, 40, 40));
    const double width = 1.0 / 40, length = stretch / 40;
    CHECK(field.least() == Approx(0.5 * std::max(width, length / 16) / (1 + 1e-3)));
  }
}
