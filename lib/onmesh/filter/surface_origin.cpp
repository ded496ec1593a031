#include "onmesh/filter/surface_origin.h"

namespace onmesh {
namespace {

/// Barycentric coordinates of the point of the triangle's plane next to `p`.
Vec3 barycentric_in(const std::array<Vec3, 3>& corner, const Vec3& p) {
  const Vec3 u = corner[1] - corner[0], v = corner[2] - corner[0], w = p - corner[0];
  const Vec3 n = u.cross(v);
  const double squared = n.squaredNorm();
  if (!(squared > 0)) return {1, 0, 0};
  const double b1 = w.cross(v).dot(n) / squared, b2 = u.cross(w).dot(n) / squared;
  return {1 - b1 - b2, b1, b2};
}

}  // namespace

SurfaceOrigin::SurfaceOrigin(const TriangleMesh& mesh, const PreparedMesh& prepared)
    : faces_(prepared.cleaning.kept) {
  // Squares of lengths hold in working units only.
  const double unit = prepared.unit;
  for (Index f = 0; f < faces_.size(); ++f) {
    auto whole = mesh.corners(faces_[f]);
    for (Vec3& p : whole) p /= unit;
    const auto part = prepared.mesh.corners(f);
    Eigen::Matrix3d& corners = corners_.emplace_back();
    for (int k = 0; k < 3; ++k) corners.col(k) = barycentric_in(whole, part[std::size_t(k)]);
  }
}

SurfacePoint SurfaceOrigin::point(Index face, const Vec3& barycentric) const {
  Vec3 own = (corners_[face] * barycentric).cwiseMax(0);
  own /= own.sum();
  return {faces_[face], own};
}

}  // namespace onmesh
