// Points of a prepared mesh on the mesh as it was given.
#pragma once

#include <vector>

#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/mesh/surface_point.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Faces of a prepared mesh may be turned over, or parts of a face that was split.
class SurfaceOrigin {
 public:
  /// \param mesh as prepare_mesh() was given it
  SurfaceOrigin(const TriangleMesh& mesh, const PreparedMesh& prepared);

  /// \param barycentric in the face of the prepared mesh
  /// \return the point of the mesh as given, inside its face
  SurfacePoint point(Index face, const Vec3& barycentric) const;

 private:
  const std::vector<Index>& faces_;
  /// Per prepared face: columns are the barycentric coordinates of its corners.
  std::vector<Eigen::Matrix3d> corners_;
};

}  // namespace onmesh
