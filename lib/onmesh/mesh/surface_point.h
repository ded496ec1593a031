// The currency between stages: a place on a triangle mesh.
#pragma once

#include "onmesh/base/types.h"

namespace onmesh {

/// A point on a triangle mesh: a face and barycentric coordinates that sum to 1.
struct SurfacePoint {
  Index face = kNone;               ///< of the mesh at hand
  Vec3 barycentric = Vec3::Zero();  ///< weights of the face's corners
};

}  // namespace onmesh
