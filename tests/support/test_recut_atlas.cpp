#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "onmesh/procedural/shapes.h"
#include "support/recut_atlas.h"
#include "support/uv_charts.h"

using namespace onmesh;

namespace {

struct Named {
  const char* name;
  TriangleMesh mesh;
};

}  // namespace

TEST_CASE("a recut atlas shows the same values at the same surface points", "[recut_atlas]") {
  const std::vector<Named> shapes{
      {"plane", make_plane(8, 8)}, {"cube", make_cube(7)}, {"gentle sheet", make_gentle_sheet(16)}};
  for (const auto& [name, mesh] : shapes) {
    INFO(name);
    const Image image = make_texture(128, 128, Pattern::noise, 0.3, 9);
    const RecutAtlas recut = recut_atlas(mesh, image, 11);
    const Index before = uv_charts(mesh).count, after = uv_charts(recut.mesh).count;
    CHECK(after == recut.charts);
    CHECK(after > before);
    CHECK(recut.mesh.faces == mesh.faces);

    // Texel centres: the same face, the same barycentric coordinates, the same value.
    const int w = recut.image.width, h = recut.image.height;
    std::set<Index> targets;
    for (Index i = 0; i < recut.new_texel.size(); ++i) {
      const Index to = recut.new_texel[i];
      if (to == kNone) continue;
      CHECK(targets.insert(to).second);
      CHECK(std::equal(image.texel(i), image.texel(i) + 3, recut.image.texel(to)));
    }
    std::size_t covered = 0;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const auto uv = mesh.corner_uvs(f), moved = recut.mesh.corner_uvs(f);
      Eigen::Matrix2d edges;
      edges << uv[1] - uv[0], uv[2] - uv[0];
      for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
          const Vec2 b = edges.inverse() * (Vec2((x + 0.5) / 128, 1 - (y + 0.5) / 128) - uv[0]);
          if (b.minCoeff() < 1e-6 || b.sum() > 1 - 1e-6) continue;
          ++covered;
          const Vec2 at = moved[0] + b.x() * (moved[1] - moved[0]) + b.y() * (moved[2] - moved[0]);
          const double px = at.x() * w - 0.5, py = (1 - at.y()) * h - 0.5;
          CHECK(std::abs(px - std::round(px)) < 1e-9);
          CHECK(std::abs(py - std::round(py)) < 1e-9);
          CHECK(recut.new_texel[Index(y * 128 + x)] == Index(std::round(py) * w + std::round(px)));
        }
      }
    }
    CHECK(covered > 3000);
    // UV areas in texels are kept, so nothing was mirrored or scaled.
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      CHECK(uv_area(recut.mesh.corner_uvs(f)) * w * h ==
            Approx(uv_area(mesh.corner_uvs(f)) * 128 * 128));
    }
  }
}

TEST_CASE("recut charts lie within the atlas, four texels apart", "[recut_atlas]") {
  const TriangleMesh mesh = make_plane(16, 16);
  const Image image = make_texture(64, 64, Pattern::checker, 0, 1);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RecutAtlas recut = recut_atlas(mesh, image, seed);
    const NumberedSets charts = uv_charts(recut.mesh);
    std::vector<std::array<double, 4>> boxes(charts.count, {1e9, 1e9, -1e9, -1e9});
    for (Index f = 0; f < recut.mesh.faces.size(); ++f) {
      for (const Vec2& uv : recut.mesh.corner_uvs(f)) {
        auto& [x0, y0, x1, y1] = boxes[charts.numbers[f]];
        x0 = std::min(x0, uv.x() * recut.image.width),
        x1 = std::max(x1, uv.x() * recut.image.width);
        y0 = std::min(y0, uv.y() * recut.image.height),
        y1 = std::max(y1, uv.y() * recut.image.height);
      }
    }
    for (Index i = 0; i < charts.count; ++i) {
      CHECK(boxes[i][0] > 3.9);
      CHECK(boxes[i][1] > 3.9);
      CHECK(boxes[i][2] < recut.image.width - 3.9);
      CHECK(boxes[i][3] < recut.image.height - 3.9);
      for (Index j = 0; j < i; ++j) {
        const bool apart = boxes[i][0] > boxes[j][2] + 3.9 || boxes[j][0] > boxes[i][2] + 3.9 ||
                           boxes[i][1] > boxes[j][3] + 3.9 || boxes[j][1] > boxes[i][3] + 3.9;
        CHECK(apart);
      }
    }
  }
}
