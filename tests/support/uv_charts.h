// The charts of an atlas, by a way of its own: through UV indices alone.
#pragma once

#include <utility>
#include <vector>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Faces connected through equal UV indices, numbered in the order of their first faces.
/// \pre all faces have UVs
inline NumberedSets uv_charts(const TriangleMesh& mesh) {
  DisjointSets uvs(mesh.uvs.size());
  for (const auto& corners : mesh.face_uvs) {
    uvs.join(corners[0], corners[1]);
    uvs.join(corners[0], corners[2]);
  }
  std::vector<Index> roots;
  for (const auto& corners : mesh.face_uvs) roots.push_back(uvs.find(corners[0]));
  return number_sets(std::move(roots));
}

/// Signed area of a triangle in UVs.
inline double uv_area(const std::array<Vec2, 3>& p) {
  const Vec2 a = p[1] - p[0], b = p[2] - p[0];
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

}  // namespace onmesh
