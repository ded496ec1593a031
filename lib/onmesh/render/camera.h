// Where a picture is taken from, and where points of the model are in it.
#pragma once

#include <vector>

#include "onmesh/render/clip.h"
#include "onmesh/render/render.h"

namespace onmesh {

/// A perspective camera outside the model's bounding sphere, framed so that the model fills the
/// picture; or as near to RenderOptions::target as its extent asks for, perhaps within the model.
class Camera {
 public:
  /// \pre the mesh has faces
  /// \throw InputError if the mesh is too large for its size to be a number
  Camera(const TriangleMesh& mesh, const RenderOptions& options);

  /// Where a point is in the picture: x right and y down in pixels, z = distance along the view,
  /// > 0.
  Vec3 project(const Vec3& p) const { return project_view(view(p)); }
  /// The point from the eye: to the right, up and ahead.
  Vec3 view(const Vec3& p) const;
  /// project() of a point in the view.
  Vec3 project_view(const Vec3& q) const;
  /// What must be cut off faces: all that is behind the eye or far from the picture, where
  /// coordinates grow without bound. Empty if the whole model is in front.
  std::vector<ViewPlane> cutting_planes(const RenderOptions& options) const;
  /// Where the camera is, in the mesh's space.
  const Vec3& eye() const { return eye_; }

 private:
  /// Set focal length and offset: the bounding sphere would leave much of the picture empty.
  void frame(const TriangleMesh& mesh, const RenderOptions& options);

  Vec3 eye_, right_, up_, forward_;
  double focal_ = 1;
  Vec2 offset_{0, 0};
  double nearest_ = 0;  ///< what is nearer is not seen, mesh units; 0 = nothing is
};

}  // namespace onmesh
