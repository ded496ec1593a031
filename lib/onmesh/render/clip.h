// What of a triangle is in front of the camera and near the picture.
#pragma once

#include <array>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// A half-space of the camera's view: normal.dot(q) + offset >= 0.
struct ViewPlane {
  Vec3 normal;
  double offset;
};

/// A triangle within a face, by the barycentric coordinates of its corners there.
using FacePart = std::array<Vec3, 3>;

/// What all half-spaces leave of a face (Sutherland and Hodgman, Reentrant polygon clipping, 1974),
/// as a fan of triangles; nothing if that has no inside.
/// \param corners of the face, in the view
std::vector<FacePart> clip_face(const std::array<Vec3, 3>& corners,
                                const std::vector<ViewPlane>& planes);

/// The whole face.
inline FacePart whole_face() { return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}; }

}  // namespace onmesh
