// UV triangles in pixel coordinates: which texel centres lie in them and which texels they touch
// (internal: the texel map and the gutter are made with it).
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "onmesh/base/convex_polygon.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A face's UV triangle in pixels: x = u W to the right, y = (1 - v) H down, texel centres at +.5.
struct UvTriangle {
  /// Edge k runs from corner k to corner k + 1. Its line is kept from the corner of the lower UV
  /// index to the other, so that two faces of a shared edge get exactly opposite values.
  struct Edge {
    Vec2 origin, direction;  ///< direction of unit length, zero if the edge has no length
    double length = 0;
    double sign = 0;  ///< makes the inside positive
  };
  std::array<Vec2, 3> corners;
  std::array<Edge, 3> edges;
  double area = 0;   ///< signed, in texels
  bool flat = true;  ///< too thin to hold a centre of its own
  Vec2 low, high;    ///< bounding box

  /// \param width of the image in texels
  /// \param height of the image in texels
  /// \param tolerance pixels: a triangle thinner than four times that is flat
  /// \pre mesh.has_uvs(face)
  UvTriangle(const TriangleMesh& mesh, Index face, int width, int height, double tolerance);

  /// Signed distance from edge k's line in pixels, positive inside.
  double edge_value(int k, const Vec2& p) const {
    const Edge& e = edges[std::size_t(k)];
    const Vec2 d = p - e.origin;
    return e.sign * (e.direction.x() * d.y() - e.direction.y() * d.x());
  }

  /// -1 if p lies outside by more than the tolerance; else bit k says that it lies on edge k.
  int locate(const Vec2& p, double tolerance) const;

  /// Squared distance in pixels, 0 inside.
  double squared_distance(const Vec2& p) const;

  /// Rows (of texels) that the triangle meets with positive area: [first, second).
  std::pair<std::int64_t, std::int64_t> rows(double tolerance) const;
  /// Columns it meets within a row of texels: [first, second).
  std::pair<std::int64_t, std::int64_t> columns(std::int64_t row, double tolerance) const;
  /// The part within the square of texel (x, y), in texels from the square's corner.
  ConvexPolygon part_in(std::int64_t x, std::int64_t y) const;
  /// Area within the square of texel (x, y), in texels.
  double area_in(std::int64_t x, std::int64_t y) const;
  /// A point of the triangle within the texel's square, in its inside if they overlap.
  /// \pre they meet
  Vec2 point_in(std::int64_t x, std::int64_t y) const;
};

/// A UV in pixels of a width x height image.
Vec2 to_pixels(const Vec2& uv, int width, int height);

/// Distances below this many pixels count as none: 1e-9, more where coordinates are so large that
/// they are not that exact.
/// \param used faces that count; the others need no UVs
double pixel_tolerance(const TriangleMesh& mesh, const std::vector<bool>& used, int width,
                       int height);

/// Surface area of one whole texel on the face, mesh units squared.
/// \param triangle of that face
/// \return 0 if the face cannot be rasterised: it has no surface area or its UV triangle is flat
double texel_area(const TriangleMesh& mesh, Index face, const UvTriangle& triangle);

}  // namespace onmesh
