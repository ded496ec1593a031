#include "onmesh/render/raster.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "onmesh/base/random.h"
#include "onmesh/base/triangle.h"
#include "onmesh/procedural/shapes.h"
#include "onmesh/render/camera.h"
#include "support/pictures.h"

using namespace onmesh;

namespace {

// The plane with its inner vertices moved about: many triangles of many shapes.
TriangleMesh shaken_plane(int n) {
  TriangleMesh mesh = make_plane(n, n);
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const bool border = p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1;
    if (border) continue;
    p.x() += 0.6 / n * (random_unit_at(1, v) - 0.5);
    p.y() += 0.6 / n * (random_unit_at(2, v) - 0.5);
  }
  return mesh;
}

}  // namespace

TEST_CASE("every sample of a triangulated square belongs to exactly one face", "[raster]") {
  constexpr int kSize = 120;
  for (const int n : {1, 7, 20}) {
    // On a grid of samples, and shaken; seen from the front, from behind and slanted.
    for (const TriangleMesh& mesh : {make_plane(n, n), shaken_plane(n)}) {
      for (const double azimuth : {0.0, 180.0, 33.0}) {
        RenderOptions options = facing(kSize);
        options.azimuth_degrees = azimuth;
        const Camera camera(mesh, options);
        std::vector<int> count(kSize * kSize);
        for (Index f = 0; f < mesh.faces.size(); ++f) {
          auto corners = mesh.corners(f);
          for (Vec3& p : corners) p = camera.project(p);
          RasterBand band{kSize, 0, kSize, std::vector<Index>(count.size(), kNone),
                          std::vector<double>(count.size())};
          draw_face(make_screen_triangle(corners, 1), f, band);
          for (std::size_t i = 0; i < count.size(); ++i) count[i] += band.face[i] != kNone;
        }
        long inside = 0;
        bool exactly_once = true;
        for (int y = 0; y < kSize; ++y) {
          const auto row = count.begin() + y * kSize;
          const auto first = std::find_if(row, row + kSize, [](int c) { return c > 0; });
          auto last = row + kSize;
          while (last > first && *(last - 1) == 0) --last;
          for (auto c = first; c < last; ++c, ++inside) exactly_once = exactly_once && *c == 1;
        }
        CHECK(exactly_once);
        CHECK(inside > 3000);
      }
    }
  }
}

TEST_CASE("attributes are interpolated in perspective", "[raster]") {
  const TriangleMesh mesh = make_plane(1, 1, 5, 1);
  RenderOptions options = facing(4000);
  options.azimuth_degrees = 70;
  options.elevation_degrees = 20;
  const Camera camera(mesh, options);
  for (Index f = 0; f < 2; ++f) {
    const auto corners = mesh.corners(f);
    const ScreenTriangle triangle = make_screen_triangle(
        {camera.project(corners[0]), camera.project(corners[1]), camera.project(corners[2])}, 1);
    for (const Vec3& b : {Vec3(0.2, 0.3, 0.5), Vec3(0.7, 0.2, 0.1), Vec3(0.3, 0.3, 0.4)}) {
      const Vec3 p = camera.project(interpolate(corners, b));
      CHECK((triangle.weights(p.x(), p.y()) - b).norm() < 1e-4);
    }
  }
}
