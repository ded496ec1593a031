// The point of a mesh that is closest to a point in space.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Precomputes a tree of bounding boxes over the mesh's faces (CGAL's AABB tree); queries are const
/// and may run in parallel. The mesh may go.
class ClosestPoint {
 public:
  /// Faces without area (1e-14 of their longest edge's square) are left out.
  /// \throw InputError if no face is left
  explicit ClosestPoint(const TriangleMesh& mesh);
  ~ClosestPoint();
  /// Can be moved, not copied.
  ClosestPoint(ClosestPoint&&) noexcept;
  /// The same.
  ClosestPoint& operator=(ClosestPoint&&) noexcept;

  /// Closest point of the surface; the lowest face index among equally close faces.
  /// \pre point is finite, here and below
  SurfacePoint closest(const Vec3& point) const;

  /// The same among the faces whose label is not `label`, if any of them is within `limit`.
  /// \param limit in mesh units
  /// \param labels one per face of the mesh
  std::optional<SurfacePoint> closest_other(const Vec3& point, double limit,
                                            const std::vector<Index>& labels, Index label) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace onmesh
