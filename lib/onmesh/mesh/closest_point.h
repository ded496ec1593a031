// Closest points on a mesh (CGAL AABB tree).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Precomputes a tree over the mesh's faces; queries are const and may run in parallel.
class ClosestPoint {
 public:
  /// \pre the mesh has a face with area; faces without area are left out
  explicit ClosestPoint(const TriangleMesh& mesh);
  ~ClosestPoint();
  ClosestPoint(ClosestPoint&&) noexcept;
  ClosestPoint& operator=(ClosestPoint&&) noexcept;

  /// Closest point of the surface; the lowest face index among equally close faces.
  SurfacePoint closest(const Vec3& point) const;

  /// The same among the faces whose label is not `label`, if any of them is within `limit`.
  /// \param labels one per face of the mesh
  std::optional<SurfacePoint> closest_other(const Vec3& point, double limit,
                                            const std::vector<Index>& labels, Index label) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Barycentric coordinates of the point of the triangle closest to p.
Vec3 closest_barycentric(const std::array<Vec3, 3>& triangle, const Vec3& p);

}  // namespace onmesh
