// The sheets of shapes.h, and what is joined of sheets.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "onmesh/procedural/grid_builder.h"
#include "onmesh/procedural/shapes.h"

namespace onmesh {
namespace {

// A sheet of nx x ny quads whose UVs fill [0,1]^2; `position` maps grid points into space and
// `u` grid columns to UVs.
TriangleMesh make_sheet(int nx, int ny, const std::function<Vec3(int, int)>& position,
                        const std::function<double(int)>& u) {
  GridBuilder grid;
  grid.add_chart(nx, ny, [&](int i, int j) {
    return GridBuilder::Point{{i, j, 0}, position(i, j), Vec2(u(i), double(j) / ny)};
  });
  return grid.take();
}

}  // namespace

TriangleMesh make_plane(int nx, int ny, double width, double height) {
  require_segments("plane", {nx, ny});
  require(positive(width) && positive(height), "plane: width and height must be positive");
  return make_sheet(
      nx, ny, [&](int i, int j) { return Vec3(width * i / nx, height * j / ny, 0); },
      [&](int i) { return double(i) / nx; });
}

TriangleMesh make_folded_sheet(int leaves, double width, double height, double angle_degrees,
                               int ny) {
  require_segments("folded sheet", {leaves, ny});
  require(positive(width) && positive(height), "folded sheet: width and height must be positive");
  require(angle_degrees >= 0 && angle_degrees < 180,
          "folded sheet: angle must be in [0, 180) degrees");
  // Leaves slope up and down by half the fold angle in turn.
  const double half = angle_degrees / 2 * std::numbers::pi / 180, leaf = width / leaves;
  return make_sheet(
      leaves, ny,
      [&](int i, int j) {
        return Vec3(i * leaf * std::cos(half), height * j / ny,
                    i % 2 == 0 ? 0 : leaf * std::sin(half));
      },
      [&](int i) { return double(i) / leaves; });
}

double u_sheet_width(double leaf, double gap, int segments) {
  return 2 * leaf + segments * gap * std::sin(std::numbers::pi / (2 * segments));
}

TriangleMesh make_u_sheet(double leaf, double height, double gap, int segments, int n) {
  require_segments("U-sheet", {segments, n});
  require(positive(leaf) && positive(height) && positive(gap),
          "U-sheet: leaf, height and gap must be positive");
  const double width = u_sheet_width(leaf, gap, segments),
               chord = gap * std::sin(std::numbers::pi / (2 * segments));
  // Columns: n along the lower leaf, `segments` around the bend, n back along the upper leaf.
  const int bend_end = n + segments;
  return make_sheet(
      bend_end + n, n,
      [&](int i, int j) {
        const double y = height * j / n;
        if (i <= n) return Vec3(leaf * i / n, y, 0);
        if (i >= bend_end) return Vec3(leaf - leaf * (i - bend_end) / n, y, gap);
        const double angle = std::numbers::pi * (i - n) / segments;
        return Vec3(leaf + gap / 2 * std::sin(angle), y, gap / 2 * (1 - std::cos(angle)));
      },
      [&](int i) {
        if (i <= n) return leaf * i / n / width;
        if (i >= bend_end) return 1 - leaf * (n - (i - bend_end)) / n / width;
        return (leaf + (i - n) * chord) / width;
      });
}

TriangleMesh make_gentle_sheet(int n, double amplitude) {
  require_segments("gentle sheet", {n});
  require(std::isfinite(amplitude), "gentle sheet: amplitude must be finite");
  return make_sheet(
      n, n,
      [&](int i, int j) {
        const double x = double(i) / n, y = double(j) / n;
        return Vec3(x, y,
                    amplitude * std::sin(std::numbers::pi * x) * std::sin(std::numbers::pi * y));
      },
      [&](int i) { return double(i) / n; });
}

TriangleMesh make_saddle(int n, double a) {
  require_segments("saddle", {n});
  require(std::isfinite(a), "saddle: a must be finite");
  return make_sheet(
      n, n,
      [&](int i, int j) {
        const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
        return Vec3(x, y, a * (x * x - y * y));
      },
      [&](int i) { return double(i) / n; });
}

TriangleMesh make_book(int n, double angle_degrees) {
  require_segments("book", {n});
  require(angle_degrees > 0 && angle_degrees < 180, "book: angle must be in (0, 180) degrees");
  const double width = 1, height = 1.4;
  const double scale =
      std::min((1 - 4 * kChartMargin) / (3 * width), (1 - 2 * kChartMargin) / height);
  GridBuilder grid;
  for (int page = 0; page < 3; ++page) {
    const double angle = (90 + (page - 1) * angle_degrees) * std::numbers::pi / 180;
    const Vec2 origin(kChartMargin + page * (width * scale + kChartMargin), kChartMargin);
    grid.add_chart(n, n, [&](int i, int j) {
      const double s = width * i / n, y = height * j / n;
      return GridBuilder::Point{{i == 0 ? 0 : page, i, j},
                                {s * std::cos(angle), y, s * std::sin(angle)},
                                origin + scale * Vec2(s, y)};
    });
  }
  return grid.take();
}

TriangleMesh make_bow_tie(int n) {
  require_segments("bow tie", {n});
  const double side = 7.0 / 16;
  GridBuilder grid;
  for (int half = 0; half < 2; ++half) {
    const double low = half - 1, uv = half * 0.5 + 1.0 / 32;
    grid.add_chart(n, n, [&](int i, int j) {
      const double x = double(i) / n, y = double(j) / n;
      return GridBuilder::Point{{(half - 1) * n + i, (half - 1) * n + j, 0},
                                {low + x, low + y, 0},
                                {uv + side * x, uv + side * y}};
    });
  }
  return grid.take();
}

}  // namespace onmesh
