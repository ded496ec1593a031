#include "onmesh/mesh/boundary.h"

#include <algorithm>

namespace onmesh {
namespace {

/// Sine of the angle below which sides of cloth lie on each other although their triangles differ,
/// so that each bends otherwise.
constexpr double kHardlyAnAngle = 0.05;

/// From the line to the corner that is farthest from it, at right angles.
Vec3 extent_beside(const std::array<Vec3, 3>& corners, const Vec3& origin, const Vec3& direction) {
  Vec3 farthest = Vec3::Zero();
  for (const Vec3& corner : corners) {
    const Vec3 way = corner - origin;
    const Vec3 beside = way - way.dot(direction) * direction;
    if (beside.squaredNorm() > farthest.squaredNorm()) farthest = beside;
  }
  return farthest;
}

}  // namespace

std::vector<BoundaryEdge> boundary_edges(const TriangleMesh& mesh) {
  std::vector<BoundaryEdge> found;
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() != 1) continue;
    const EdgeSide& side = edges.sides(e)[0];
    const auto& corners = mesh.faces[side.face];
    found.push_back(
        {{corners[side.corner], corners[(side.corner + 1U) % 3]}, side.face, side.corner});
  }
  return found;
}

EdgesAtVertices::EdgesAtVertices(const std::vector<BoundaryEdge>& edges, std::size_t vertices)
    : offsets_(vertices + 1, 0), edges_(2 * edges.size()) {
  for (const BoundaryEdge& edge : edges) {
    for (const Index v : edge.ends) ++offsets_[v + 1];
  }
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
  for (Index e = 0; e < edges.size(); ++e) {
    for (const Index v : edges[e].ends) edges_[next[v]++] = e;
  }
}

bool lie_on_each_other(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second,
                       const Vec3& a, const Vec3& b, double thickness) {
  const Vec3 direction = (b - a).normalized();
  const Vec3 p = extent_beside(first, a, direction), q = extent_beside(second, a, direction);
  const double narrower = std::min(p.norm(), q.norm()), wider = std::max(p.norm(), q.norm());
  if (!(p.dot(q) > 0) || !(narrower > thickness)) return false;
  const double apart = p.cross(q).norm() / wider;  // where the narrower face ends
  return apart <= std::max(thickness, kHardlyAnAngle * narrower);
}

}  // namespace onmesh
