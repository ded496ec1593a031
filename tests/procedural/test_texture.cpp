#include "onmesh/procedural/texture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "onmesh/base/error.h"
#include "onmesh/procedural/shapes.h"

using namespace onmesh;

TEST_CASE("patterns stay in range, repeat with their seed and differ from each other",
          "[texture]") {
  std::set<std::vector<float>> seen;
  for (const Pattern pattern :
       {Pattern::checker, Pattern::stripes, Pattern::noise, Pattern::gradient, Pattern::dots}) {
    const Image image = make_texture(40, 30, pattern, 0.2, 3);
    CHECK(image.pixels == make_texture(40, 30, pattern, 0.2, 3).pixels);
    CHECK(image.pixels != make_texture(40, 30, pattern, 0.2, 4).pixels);
    const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
    CHECK(*low >= 0);
    CHECK(*high <= 1);
    CHECK(*high - *low > 0.3);
    seen.insert(make_texture(40, 30, pattern, 0, 3).pixels);
  }
  CHECK(seen.size() == 5);
}

TEST_CASE("texture noise is uniform around zero", "[texture]") {
  const Image clean = make_texture(256, 256, Pattern::gradient, 0, 1),
              noisy = make_texture(256, 256, Pattern::gradient, 0.1, 1);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < clean.pixels.size(); ++i) {
    const double d = double(noisy.pixels[i]) - clean.pixels[i];
    sum += d, squares += d * d;
  }
  const double n = double(clean.pixels.size());
  CHECK(std::abs(sum / n) < 1e-3);
  CHECK(squares / n == Approx(0.01 / 3).epsilon(0.02));
}

TEST_CASE("a surface texture is continuous across seams", "[texture]") {
  // On the gradient, colours are linear in position: any texel of any chart must show its own
  // place.
  const TriangleMesh cube = make_cube();
  SurfaceTextureOptions options;
  options.pattern = Pattern::gradient;
  const Image image = make_surface_texture(cube, 128, 128, options);
  for (Index f = 0; f < cube.faces.size(); ++f) {
    const auto uv = cube.corner_uvs(f);
    const auto p = cube.corners(f);
    for (const Vec3& b : {Vec3(0.6, 0.2, 0.2), Vec3(0.1, 0.2, 0.7)}) {
      const Vec2 at = b[0] * uv[0] + b[1] * uv[1] + b[2] * uv[2];
      const Vec3 position = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
      const int x = int(at.x() * 128), y = int((1 - at.y()) * 128);
      for (int c = 0; c < 3; ++c) {
        const double expected = 0.1 + 0.8 * (position[c] + 1) / 2;
        CHECK(std::abs(double(image.texel(Index(y * 128 + x))[c]) - expected) < 0.8 * 0.75 / 28);
      }
    }
  }
}

TEST_CASE("texture sizes and noise outside their domain are refused", "[texture]") {
  CHECK_THROWS_AS(make_texture(0, 1, Pattern::dots, 0, 1), UsageError);
  CHECK_THROWS_AS(make_texture(1, 1, Pattern::dots, 2, 1), UsageError);
  CHECK_THROWS_AS(make_surface_texture(TriangleMesh(), 8, 8, {}), UsageError);
}
