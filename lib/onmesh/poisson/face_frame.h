// Faces laid out in the plane, and rectangles that divide them (internal).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "onmesh/base/types.h"

namespace onmesh {

/// A face in its own plane: the longest edge runs along x from the origin, and the third corner is
/// above it, so that the bounding box is tight however thin the face is.
struct FaceFrame {
  FaceFrame(Index index, const std::array<Vec3, 3>& corners) : face(index) {
    double squared = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double l = (corners[(k + 1) % 3] - corners[k]).squaredNorm();
      if (l <= squared) continue;
      squared = l;
      first = k;
    }
    origin = corners[first];
    const Vec3 side = corners[(first + 2) % 3] - origin;
    x_axis = corners[(first + 1) % 3] - origin;
    size.x() = x_axis.norm();
    x_axis /= size.x();
    y_axis = side - side.dot(x_axis) * x_axis;
    y_axis -= y_axis.dot(x_axis) * x_axis;  // again, for slivers
    size.y() = y_axis.norm();
    if (size.y() > 0) y_axis /= size.y();
    apex_x = side.dot(x_axis);
  }

  Vec3 position(const Vec2& p) const { return origin + p.x() * x_axis + p.y() * y_axis; }
  /// In the order of the frame: of the origin, the end of the longest edge, and the apex.
  Vec3 frame_barycentric(const Vec2& p) const {
    const double up = p.y() / size.y(), along = (p.x() - up * apex_x) / size.x();
    return {1 - along - up, along, up};
  }
  /// In the order of the face's corners.
  Vec3 barycentric(const Vec2& p) const {
    const Vec3 in_frame = frame_barycentric(p);
    Vec3 b;
    for (std::size_t k = 0; k < 3; ++k) b[int((first + k) % 3)] = in_frame[int(k)];
    return b;
  }

  Index face;
  std::size_t first = 0;  // corner at the origin
  Vec3 origin, x_axis, y_axis;
  Vec2 size = Vec2::Zero();  // of the bounding box
  double apex_x = 0;
};

/// A rectangle in a face's frame, standing for the part of it inside the face.
struct Cell {
  Vec2 low, high;

  Vec2 centre() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low).norm(); }
  double area() const { return (high - low).prod(); }
  /// Whether it meets the face. Only rounding decides when they just touch.
  bool meets(const FaceFrame& frame) const {
    // On the inner side of each edge, at the best corner: the centre and half the sides.
    const Vec3 b = frame.frame_barycentric(centre());
    const Vec2 half = 0.5 * (high - low);
    const double slope = frame.apex_x / (frame.size.x() * frame.size.y());
    const double along = half.x() / frame.size.x();
    return b[0] + along + std::abs(slope - 1 / frame.size.y()) * half.y() >= 0 &&
           b[1] + along + std::abs(slope) * half.y() >= 0 && b[2] + half.y() / frame.size.y() >= 0;
  }
  std::array<Cell, 2> split() const {
    const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    std::array<Cell, 2> halves{*this, *this};
    halves[0].high[axis] = halves[1].low[axis] = 0.5 * (low[axis] + high[axis]);
    return halves;
  }
};

}  // namespace onmesh
