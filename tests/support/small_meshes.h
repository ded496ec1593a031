// Meshes of a few faces, written out by hand.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A mesh without UVs and materials.
inline TriangleMesh bare_mesh(std::vector<Vec3> positions,
                              std::vector<std::array<Index, 3>> faces) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  mesh.face_uvs.assign(mesh.faces.size(), {kNone, kNone, kNone});
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

/// A tetrahedron with three edges of length 1 along the axes, wound outward.
inline TriangleMesh corner_tetrahedron() {
  return bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

/// Add a face without material.
inline void add_face(TriangleMesh& mesh, const std::array<Index, 3>& corners,
                     const std::array<Index, 3>& uvs = {kNone, kNone, kNone}) {
  mesh.faces.push_back(corners);
  mesh.face_uvs.push_back(uvs);
  mesh.face_materials.push_back(kNone);
}

}  // namespace onmesh
