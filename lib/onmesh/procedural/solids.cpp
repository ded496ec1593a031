// The boxes, and the surfaces of revolution, of shapes.h.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/procedural/grid_builder.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

// The six faces of a box with n x n quads each, as one cross in the atlas:
//
//            top
//     left  front  right  back
//           bottom
//
// `origin` is the lower left corner of the cross in UVs, `scale` UVs per length, `margin` the
// distance between neighbouring charts.
void add_box(GridBuilder& grid, long key, int n, const Vec3& low, const Vec3& high,
             const Vec2& origin, double scale, double margin) {
  const Vec3 size = high - low;
  const double w = size.x() * scale, h = size.y() * scale, d = size.z() * scale;
  const double x0 = origin.x(), x1 = x0 + d + margin, x2 = x1 + w + margin, x3 = x2 + d + margin;
  const double y0 = origin.y(), y1 = y0 + d + margin, y2 = y1 + h + margin;
  // A chart's lower left corner in the atlas, its size there, and its corner and sides as box
  // corners (0 or 1 per axis).
  struct Side {
    Vec2 uv, size;
    Eigen::Vector3i corner, right, up;
  };
  const Side sides[] = {{{x0, y1}, {d, h}, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                        {{x1, y1}, {w, h}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                        {{x2, y1}, {d, h}, {1, 0, 1}, {0, 0, -1}, {0, 1, 0}},
                        {{x3, y1}, {w, h}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}},
                        {{x1, y2}, {w, d}, {0, 1, 1}, {1, 0, 0}, {0, 0, -1}},
                        {{x1, y0}, {w, d}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  for (const Side& side : sides) {
    grid.add_chart(n, n, [&](int i, int j) {
      const Eigen::Vector3i at = n * side.corner + i * side.right + j * side.up;
      Vec3 position;
      for (int k = 0; k < 3; ++k) position[k] = low[k] + (high[k] - low[k]) * (double(at[k]) / n);
      const Vec2 uv = side.uv + Vec2(side.size.x() * i / n, side.size.y() * j / n);
      return GridBuilder::Point{{key + at[0], at[1], at[2]}, position, uv};
    });
  }
}

}  // namespace

TriangleMesh make_cube(int n) {
  require_segments("cube", {n});
  // Cells of 1/4 with charts of 7/32: all UVs are dyadic for n = 1, 2, 4, ...
  GridBuilder grid;
  add_box(grid, 0, n, -Vec3::Ones(), Vec3::Ones(), Vec2(1.0 / 64, 0.25 + 1.0 / 64), 7.0 / 64,
          1.0 / 32);
  return grid.take();
}

TriangleMesh make_torus(int nu, int nv, double major_radius, double minor_radius) {
  require_segments("torus", {nu, nv}, 3);
  require(positive(minor_radius) && positive(major_radius) && minor_radius < major_radius,
          "torus: radii must be positive, the minor one smaller than the major one");
  const double side = 1 - 2 * kChartMargin, aspect = minor_radius / major_radius;
  GridBuilder grid;
  grid.add_chart(nu, nv, [&](int i, int j) {
    const double u = 2 * std::numbers::pi * (i % nu) / nu, v = 2 * std::numbers::pi * (j % nv) / nv;
    const double ring = major_radius + minor_radius * std::cos(v);
    return GridBuilder::Point{
        {i % nu, j % nv, 0},
        {ring * std::cos(u), ring * std::sin(u), minor_radius * std::sin(v)},
        {kChartMargin + side * i / nu, 0.5 + side * aspect * (double(j) / nv - 0.5)}};
  });
  return grid.take();
}

TriangleMesh make_cone(double sector_degrees, int n, int rings) {
  require_segments("cone", {rings});
  require_segments("cone", {n}, 3);
  require(sector_degrees > 0 && sector_degrees < 360, "cone: sector must be in (0, 360) degrees");
  const double facet = sector_degrees * std::numbers::pi / 180 / n;  // a facet's angle at the apex
  const double base = std::sin(facet / 2) / std::sin(std::numbers::pi / n),
               depth = std::sqrt(1 - base * base);
  // The sector's bounding box decides the scale of its chart.
  Vec2 low(0, 0), high(0, 0);
  const auto flat = [&](int i) { return Vec2(std::cos(i * facet), std::sin(i * facet)); };
  for (int i = 0; i <= n; ++i) low = low.cwiseMin(flat(i)), high = high.cwiseMax(flat(i));
  const double scale = (1 - 2 * kChartMargin) / (high - low).maxCoeff();
  const Vec2 apex = Vec2(0.5, 0.5) - scale * (low + high) / 2;

  // Columns run around, rows from the apex outward; the order (outward, around) winds it outward.
  GridBuilder grid;
  grid.add_chart(rings, n, [&](int ring, int i) {
    const double t = double(ring) / rings, angle = 2 * std::numbers::pi * (i % n) / n;
    const GridBuilder::Key key =
        ring == 0 ? GridBuilder::Key{0, 0, 0} : GridBuilder::Key{ring, i % n, 0};
    return GridBuilder::Point{key, t * Vec3(base * std::cos(angle), base * std::sin(angle), -depth),
                              apex + scale * t * flat(i)};
  });
  TriangleMesh mesh = grid.take();
  // The apex is one UV as well, not one per facet.
  for (auto& corners : mesh.face_uvs) {
    for (Index& uv : corners) {
      if (mesh.uvs[uv] == apex) uv = 0;
    }
  }
  return mesh;
}

double cylinder_circumference(int n, double radius) {
  return 2 * n * radius * std::sin(std::numbers::pi / n);
}

TriangleMesh make_cylinder(int n, int rings, double radius, double height) {
  require_segments("cylinder", {rings});
  require_segments("cylinder", {n}, 3);
  require(positive(radius) && positive(height), "cylinder: radius and height must be positive");
  const double width = cylinder_circumference(n, radius);
  const double scale = (1 - 2 * kChartMargin) / std::max(width, height);
  const Vec2 origin = Vec2(0.5, 0.5) - scale / 2 * Vec2(width, height);
  GridBuilder grid;
  grid.add_chart(n, rings, [&](int i, int j) {
    const double angle = 2 * std::numbers::pi * (i % n) / n, z = height * (double(j) / rings - 0.5);
    return GridBuilder::Point{{i % n, j, 0},
                              {radius * std::cos(angle), radius * std::sin(angle), z},
                              origin + scale * Vec2(width * i / n, height * j / rings)};
  });
  return grid.take();
}

TriangleMesh make_chest(int n, double gap) {
  require_segments("chest", {n});
  require(positive(gap), "chest: gap must be positive");
  const double w = 2, h = 1, lid = 0.4, d = 1.4;
  const double margin = kChartMargin;
  const double scale =
      std::min((1 - 5 * margin) / (2 * w + 2 * d), (1 - 7 * margin) / (4 * d + h + lid));
  GridBuilder grid;
  const double base =
      2 * margin + 2 * (d * scale + margin) + h * scale;  // lower end of the lid's cross
  add_box(grid, 0, n, Vec3(-w / 2, 0, -d / 2), Vec3(w / 2, h, d / 2), Vec2(margin, margin), scale,
          margin);
  add_box(grid, 1L << 20, n, Vec3(-w / 2, h + gap, -d / 2), Vec3(w / 2, h + gap + lid, d / 2),
          Vec2(margin, base), scale, margin);
  return grid.take();
}

}  // namespace onmesh
