// Areas of whole meshes.
#pragma once

#include <vector>

#include "onmesh/base/triangle.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

inline double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) sum += mesh.face_area(f);
  return sum;
}

/// Bridges count as well.
inline double area_of(const NodeMesh& nodes) {
  double sum = 0;
  for (Index f = 0; f < nodes.faces.size(); ++f) sum += nodes.face_area(f);
  return sum;
}

/// \param weights per face; empty = 1 each
inline double area_of(const Patch& patch, const std::vector<float>& weights = {}) {
  double sum = 0;
  for (std::size_t f = 0; f < patch.lengths.size(); ++f) {
    const auto& l = patch.lengths[f];
    sum += triangle_area(l[0], l[1], l[2]) * (weights.empty() ? 1.0 : double(weights[f]));
  }
  return sum;
}

}  // namespace onmesh
