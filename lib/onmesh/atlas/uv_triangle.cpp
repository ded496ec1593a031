#include "onmesh/atlas/uv_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {

Vec2 to_pixels(const Vec2& uv, int width, int height) {
  return {uv.x() * width, (1 - uv.y()) * height};
}

double pixel_tolerance(const TriangleMesh& mesh, const std::vector<bool>& used, int width,
                       int height) {
  double largest = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!used[f]) continue;
    for (const Vec2& uv : mesh.corner_uvs(f))
      largest = std::max(largest, to_pixels(uv, width, height).cwiseAbs().maxCoeff());
  }
  return std::max(1e-9, 16 * std::numeric_limits<double>::epsilon() * largest);
}

double texel_area(const TriangleMesh& mesh, Index face, const UvTriangle& triangle) {
  if (triangle.flat || mesh.is_degenerate(face)) return 0;
  const double texel = mesh.face_area(face) / std::abs(triangle.area);
  return std::isfinite(texel) ? texel : 0;
}

UvTriangle::UvTriangle(const TriangleMesh& mesh, Index face, int width, int height,
                       double tolerance) {
  const auto& uv = mesh.face_uvs[face];
  for (std::size_t k = 0; k < 3; ++k) corners[k] = to_pixels(mesh.uvs[uv[k]], width, height);
  low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  area = cross(corners[1] - corners[0], corners[2] - corners[0]) / 2;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const bool forward = uv[k] <= uv[l];
    Edge& e = edges[k];
    e.origin = corners[forward ? k : l];
    e.direction = corners[forward ? l : k] - e.origin;
    e.length = e.direction.norm();
    if (e.length > 0) e.direction /= e.length;
    e.sign = forward == (area > 0) ? 1 : -1;
    longest = std::max(longest, e.length);
  }
  flat = !(2 * std::abs(area) > 4 * tolerance * longest);
}

int UvTriangle::locate(const Vec2& p, double tolerance) const {
  int on = 0;
  bool outside = false;
  if (!flat) {
    for (int k = 0; k < 3; ++k) {
      const double value = edge_value(k, p);
      if (value < -tolerance) return -1;
      if (value <= tolerance) on |= 1 << k;
      outside = outside || value < 0;
    }
    if (!outside) return on;
  }
  // Just outside an edge's line is near the triangle only if it is near the edge itself.
  bool near = false;
  for (int k = 0; k < 3; ++k) {
    const auto& a = corners[std::size_t(k)];
    const auto& b = corners[std::size_t((k + 1) % 3)];
    if (squared_distance_to_segment(p, a, b) > tolerance * tolerance) continue;
    near = true;
    on |= 1 << k;
  }
  return near ? on : -1;
}

double UvTriangle::squared_distance(const Vec2& p) const {
  bool inside = area != 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    inside = inside && edge_value(k, p) >= 0;
    least = std::min(least, squared_distance_to_segment(p, corners[std::size_t(k)],
                                                        corners[std::size_t((k + 1) % 3)]));
  }
  return inside ? 0 : least;
}

std::pair<std::int64_t, std::int64_t> UvTriangle::rows(double tolerance) const {
  return {std::int64_t(std::floor(low.y() + tolerance)),
          std::int64_t(std::ceil(high.y() - tolerance))};
}

std::pair<std::int64_t, std::int64_t> UvTriangle::columns(std::int64_t row,
                                                          double tolerance) const {
  // What a row of squares cuts out is convex with its corners on the triangle's edges, so its
  // extent in x decides which squares it meets.
  const double top = double(row), bottom = top + 1;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % 3];
    const double y0 = std::max(top, std::min(a.y(), b.y()));
    const double y1 = std::min(bottom, std::max(a.y(), b.y()));
    if (y0 > y1) continue;
    for (const double y : {y0, y1}) {
      // An end inside the row is taken as it is: no rounding where charts end at texel borders.
      const auto at = [&](const Vec2& p, const Vec2& q) {
        return p.x() + (q.x() - p.x()) * ((y - p.y()) / (q.y() - p.y()));
      };
      const double x = y == a.y() ? a.x() : y == b.y() ? b.x() : at(a, b);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (a.y() == b.y()) {
      left = std::min({left, a.x(), b.x()});
      right = std::max({right, a.x(), b.x()});
    }
  }
  if (!(right - left > tolerance)) return {0, 0};
  return {std::int64_t(std::floor(left + tolerance)), std::int64_t(std::ceil(right - tolerance))};
}

ConvexPolygon UvTriangle::part_in(std::int64_t x, std::int64_t y) const {
  const Vec2 corner{double(x), double(y)};
  ConvexPolygon part(corners[0] - corner, corners[1] - corner, corners[2] - corner);
  part.clip({0, 0}, {1, 0});
  part.clip({1, 1}, {-1, 0});
  part.clip({0, 0}, {0, 1});
  part.clip({1, 1}, {0, -1});
  return part;
}

double UvTriangle::area_in(std::int64_t x, std::int64_t y) const { return part_in(x, y).area(); }

Vec2 UvTriangle::point_in(std::int64_t x, std::int64_t y) const {
  return Vec2(double(x), double(y)) + part_in(x, y).centre();
}

}  // namespace onmesh
