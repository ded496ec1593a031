// UV triangles in pixel coordinates: which texel centres lie in them and which texels they touch
// (internal: the texel map and the gutter are made with it).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A UV triangle in pixels: x = u W to the right, y = (1 - v) H down, texel centres at +.5.
struct PixelTriangle {
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

  PixelTriangle(const TriangleMesh& mesh, Index face, int width, int height, double tolerance);

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

  /// Rows (of squares) that the triangle meets with positive area: [first, second).
  std::pair<std::int64_t, std::int64_t> rows(double tolerance) const;
  /// Columns it meets within a row of squares: [first, second).
  std::pair<std::int64_t, std::int64_t> columns(std::int64_t row, double tolerance) const;
  /// Area within the texel's square.
  double area_in(std::int64_t x, std::int64_t y) const;
  /// A point of the triangle within the texel's square, in its inside if they overlap.
  /// \pre they meet
  Vec2 point_in(std::int64_t x, std::int64_t y) const;

 private:
  using Polygon = std::array<Vec2, 8>;
  /// Clip to the texel's square, coordinates relative to the square's corner; returns the size.
  std::size_t clip(std::int64_t x, std::int64_t y, Polygon& polygon) const;
};

Vec2 to_pixels(const Vec2& uv, int width, int height);

/// Distances below this many pixels count as none: 1e-9, more where coordinates are so large that
/// they are not that exact.
double pixel_tolerance(const TriangleMesh& mesh, const std::vector<bool>& used, int width,
                       int height);

/// The faces around each UV index, to find who shares an edge or a vertex of a chart: there both
/// the position and the UV are the same.
class UvNeighbours {
 public:
  UvNeighbours(const TriangleMesh& mesh, const std::vector<bool>& used);

  /// Call visit(face) for every other face that has edge k of the face, with equal UVs.
  template <class Visit>
  void across_edge(Index face, int k, Visit&& visit) const {
    const int l = (k + 1) % 3;
    const auto& p = mesh_.faces[face];
    const auto& u = mesh_.face_uvs[face];
    const std::size_t a = std::size_t(k), b = std::size_t(l);
    const Index around = count(u[a]) <= count(u[b]) ? u[a] : u[b];
    for (Index i = offsets_[around]; i < offsets_[around + 1]; ++i) {
      const Index other = faces_[i];
      if (other != face && has_corner(other, p[a], u[a]) && has_corner(other, p[b], u[b]) &&
          (i == offsets_[around] || faces_[i - 1] != other))
        visit(other);
    }
  }

  /// Call visit(face) for every other face that has corner k of the face, with an equal UV.
  template <class Visit>
  void around_corner(Index face, int k, Visit&& visit) const {
    const Index p = mesh_.faces[face][std::size_t(k)], u = mesh_.face_uvs[face][std::size_t(k)];
    for (Index i = offsets_[u]; i < offsets_[u + 1]; ++i)
      if (faces_[i] != face && has_corner(faces_[i], p, u)) visit(faces_[i]);
  }

 private:
  Index count(Index uv) const { return offsets_[uv + 1] - offsets_[uv]; }
  bool has_corner(Index face, Index position, Index uv) const {
    const auto& p = mesh_.faces[face];
    const auto& u = mesh_.face_uvs[face];
    return (p[0] == position && u[0] == uv) || (p[1] == position && u[1] == uv) ||
           (p[2] == position && u[2] == uv);
  }

  const TriangleMesh& mesh_;
  std::vector<Index> offsets_, faces_;
};

}  // namespace onmesh
