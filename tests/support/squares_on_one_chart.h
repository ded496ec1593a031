// A surface whose texels are claimed twice.
#pragma once

#include "onmesh/procedural/shapes.h"

namespace onmesh {

/// Two squares apart from each other, the second twice as large, with the same UVs.
inline TriangleMesh squares_on_one_chart() {
  TriangleMesh mesh = make_plane(1, 1, 1, 1);
  const auto vertices = Index(mesh.positions.size());
  const std::size_t faces = mesh.faces.size();
  for (Index v = 0; v < vertices; ++v) {
    mesh.positions.push_back(2 * mesh.positions[v] + Vec3(0, 0, 10));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const auto corners = mesh.faces[f];
    mesh.faces.push_back({corners[0] + vertices, corners[1] + vertices, corners[2] + vertices});
    mesh.face_uvs.push_back(mesh.face_uvs[f]);
    mesh.face_materials.push_back(mesh.face_materials[f]);
  }
  return mesh;
}

}  // namespace onmesh
