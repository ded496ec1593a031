// Vectors in the plane.
#pragma once

#include "onmesh/base/types.h"

namespace onmesh {

/// |a| |b| times the sine of the angle from a to b, which is positive anticlockwise.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the signed area of the triangle a b c, positive if its corners run anticlockwise.
inline double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(b - a, c - a);
}

}  // namespace onmesh
