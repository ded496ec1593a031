// Half-edges as flat arrays: a triangulated surface by its connectivity and edge lengths.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// A triangulated surface given by connectivity and edge lengths. Half-edge 3 f + k runs from
/// corner k of face f to corner k + 1; its face lies on its left. Several edges may join the same
/// two vertices, and an edge may join a vertex to itself, so edges are never looked up by their
/// ends.
struct HalfEdges {
  std::vector<Index> tail;     ///< per half-edge: the vertex it starts at
  std::vector<Index> twin;     ///< per half-edge: the other side; kNone on the boundary
  std::vector<double> length;  ///< per half-edge, equal on both sides

  static Index face(Index h) { return h / 3; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index face_count() const { return static_cast<Index>(tail.size() / 3); }
  Index tip(Index h) const { return tail[next(h)]; }
  /// The next outgoing half-edge counter-clockwise around the tail; kNone beyond the boundary.
  Index rotate(Index h) const { return twin[prev(h)]; }

  /// Interior angle at the tail of h, in its face, radians.
  double corner_angle(Index h) const;
  double area(Index face) const;
  /// Radius of the circle through the face's corners; large and finite for a face without area.
  double circumradius(Index face) const;
  double shortest_edge(Index face) const;
  /// The face laid out in the plane: corner 0 at the origin, corner 1 on the positive x axis.
  std::array<Vec2, 3> layout(Index face) const;
  /// Where the vertex opposite h lies when h runs from `a` to `b`: on the left of it.
  Vec2 opposite(Index h, const Vec2& a, const Vec2& b) const;
  /// Sum of the cotangents of the angles opposite the edge: negative if it is not Delaunay.
  /// \pre h has a twin
  double cotan_sum(Index h) const;
  /// Whether the edge is on the boundary or its cotan_sum() is not negative but for rounding.
  bool is_delaunay(Index h) const;

  /// Replace the edge by the other diagonal of its two faces, which keep their numbers. Half-edge h
  /// and its twin become the new diagonal's; the other four move: see around().
  /// \return false on the boundary, where both sides are one face, or where the two faces do not
  ///   form a strictly convex quadrilateral
  bool flip(Index h);
  /// The four half-edges around an edge and its twin in their cyclic order. A flip moves what is at
  /// each of them to the place of the one before.
  std::array<Index, 4> around(Index h) const {
    return {next(h), prev(h), next(twin[h]), prev(twin[h])};
  }
  /// Flip until every edge is Delaunay (Lawson's algorithm), starting with the given half-edges.
  /// \param flip_edge called to flip an edge with two sides; false if it cannot
  /// \return number of flips
  Index flip_to_delaunay(std::vector<Index> suspects, const std::function<bool(Index)>& flip_edge);
};

/// Lengthen all edges by one common amount, about 1e-12 of their mean, if the triangle inequality
/// leaves a face less than that to spare (intrinsic mollification; Sharp & Crane, A Laplacian for
/// Nonmanifold Triangle Meshes, 2020, section 4.5).
void mollify(HalfEdges& edges);

/// Barycentric coordinates of a point in a counter-clockwise planar triangle, clamped to it.
Vec3 planar_barycentric(const std::array<Vec2, 3>& corners, const Vec2& p);

}  // namespace onmesh
