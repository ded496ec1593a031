#include "onmesh/procedural/shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include <Eigen/Dense>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr double kPi = std::numbers::pi;

void require(bool condition, const char* message) {
  if (!condition) throw UsageError(message);
}

void require_segments(const char* shape, std::initializer_list<int> counts, int least = 1) {
  for (const int n : counts) {
    if (n < least || n > 8192)
      throw UsageError(std::string(shape) + ": segments must be between " + std::to_string(least) +
                       " and 8192");
  }
}

bool positive(double x) { return x > 0 && std::isfinite(x); }

void add_face(TriangleMesh& mesh, const std::array<Index, 3>& corners,
              const std::array<Index, 3>& uvs) {
  mesh.faces.push_back(corners);
  mesh.face_uvs.push_back(uvs);
  mesh.face_materials.push_back(kNone);
}

// Adds charts that are grids of quads, each split into two triangles. Grid points of equal key are
// one vertex, within a chart and between charts.
class GridBuilder {
 public:
  using Key = std::tuple<long, long, long>;
  struct Point {
    Key key;
    Vec3 position;
    Vec2 uv;
  };

  // Counter-clockwise in (i, j).
  void add_chart(int nx, int ny, const std::function<Point(int, int)>& point) {
    const auto columns = Index(nx) + 1;
    const auto first_uv = Index(mesh_.uvs.size());
    std::vector<Index> vertices;
    vertices.reserve(std::size_t(columns) * (std::size_t(ny) + 1));
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Point p = point(i, j);
        const auto [entry, is_new] = vertex_of_.try_emplace(p.key, Index(mesh_.positions.size()));
        if (is_new) mesh_.positions.push_back(p.position);
        vertices.push_back(entry->second);
        mesh_.uvs.push_back(p.uv);
      }
    }
    for (Index j = 0; j < Index(ny); ++j) {
      for (Index i = 0; i < Index(nx); ++i) {
        const Index a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
        add(vertices, first_uv, {a, b, c});
        add(vertices, first_uv, {a, c, d});
      }
    }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  void add(const std::vector<Index>& vertices, Index first_uv, const std::array<Index, 3>& grid) {
    const std::array<Index, 3> corners{vertices[grid[0]], vertices[grid[1]], vertices[grid[2]]};
    // A row of the grid may shrink to a point (the tip of a cone).
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    add_face(mesh_, corners, {first_uv + grid[0], first_uv + grid[1], first_uv + grid[2]});
  }

  TriangleMesh mesh_;
  std::map<Key, Index> vertex_of_;
};

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
  const double half = angle_degrees / 2 * kPi / 180, leaf = width / leaves;
  return make_sheet(
      leaves, ny,
      [&](int i, int j) {
        return Vec3(i * leaf * std::cos(half), height * j / ny,
                    i % 2 == 0 ? 0 : leaf * std::sin(half));
      },
      [&](int i) { return double(i) / leaves; });
}

double u_sheet_width(double leaf, double gap, int segments) {
  return 2 * leaf + segments * gap * std::sin(kPi / (2 * segments));
}

TriangleMesh make_u_sheet(double leaf, double height, double gap, int segments, int n) {
  require_segments("U-sheet", {segments, n});
  require(positive(leaf) && positive(height) && positive(gap),
          "U-sheet: leaf, height and gap must be positive");
  const double width = u_sheet_width(leaf, gap, segments),
               chord = gap * std::sin(kPi / (2 * segments));
  // Columns: n along the lower leaf, `segments` around the bend, n back along the upper leaf.
  const int bend_end = n + segments;
  return make_sheet(
      bend_end + n, n,
      [&](int i, int j) {
        const double y = height * j / n;
        if (i <= n) return Vec3(leaf * i / n, y, 0);
        if (i >= bend_end) return Vec3(leaf - leaf * (i - bend_end) / n, y, gap);
        const double angle = kPi * (i - n) / segments;
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
        return Vec3(x, y, amplitude * std::sin(kPi * x) * std::sin(kPi * y));
      },
      [&](int i) { return double(i) / n; });
}

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
    const double u = 2 * kPi * (i % nu) / nu, v = 2 * kPi * (j % nv) / nv;
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
  const double facet = sector_degrees * kPi / 180 / n;  // a facet's angle at the apex
  const double base = std::sin(facet / 2) / std::sin(kPi / n), depth = std::sqrt(1 - base * base);
  // The sector's bounding box decides the scale of its chart.
  Vec2 low(0, 0), high(0, 0);
  const auto flat = [&](int i) { return Vec2(std::cos(i * facet), std::sin(i * facet)); };
  for (int i = 0; i <= n; ++i) low = low.cwiseMin(flat(i)), high = high.cwiseMax(flat(i));
  const double scale = (1 - 2 * kChartMargin) / (high - low).maxCoeff();
  const Vec2 apex = Vec2(0.5, 0.5) - scale * (low + high) / 2;

  // Columns run around, rows from the apex outward; the order (outward, around) winds it outward.
  GridBuilder grid;
  grid.add_chart(rings, n, [&](int ring, int i) {
    const double t = double(ring) / rings, angle = 2 * kPi * (i % n) / n;
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

double cylinder_circumference(int n, double radius) { return 2 * n * radius * std::sin(kPi / n); }

TriangleMesh make_cylinder(int n, int rings, double radius, double height) {
  require_segments("cylinder", {rings});
  require_segments("cylinder", {n}, 3);
  require(positive(radius) && positive(height), "cylinder: radius and height must be positive");
  const double width = cylinder_circumference(n, radius);
  const double scale = (1 - 2 * kChartMargin) / std::max(width, height);
  const Vec2 origin = Vec2(0.5, 0.5) - scale / 2 * Vec2(width, height);
  GridBuilder grid;
  grid.add_chart(n, rings, [&](int i, int j) {
    const double angle = 2 * kPi * (i % n) / n, z = height * (double(j) / rings - 0.5);
    return GridBuilder::Point{{i % n, j, 0},
                              {radius * std::cos(angle), radius * std::sin(angle), z},
                              origin + scale * Vec2(width * i / n, height * j / rings)};
  });
  return grid.take();
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
    const double angle = (90 + (page - 1) * angle_degrees) * kPi / 180;
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
