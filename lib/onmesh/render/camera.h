// Where a picture is taken from, and where points of the model are in it.
#pragma once

#include "onmesh/render/render.h"

namespace onmesh {

/// A perspective camera outside the model's bounding sphere, framed so that the model fills the
/// picture.
class Camera {
 public:
  /// \pre the mesh has faces
  /// \throw InputError if the mesh is too large for its size to be a number
  Camera(const TriangleMesh& mesh, const RenderOptions& options);

  /// Where a point is in the picture: x right and y down in pixels, z = distance along the view,
  /// > 0.
  Vec3 project(const Vec3& p) const;
  /// Where the camera is, in the mesh's space.
  const Vec3& eye() const { return eye_; }

 private:
  /// Set focal length and offset: the bounding sphere would leave much of the picture empty.
  void frame(const TriangleMesh& mesh, const RenderOptions& options);
  /// The point from the eye: to the right, up and ahead.
  Vec3 view(const Vec3& p) const;

  Vec3 eye_, right_, up_, forward_;
  double focal_ = 1;
  Vec2 offset_{0, 0};
};

}  // namespace onmesh
