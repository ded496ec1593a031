// The normals that a mesh is lit by.
#pragma once

#include <array>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Unit normals at the corners of every face: the mesh's own; where it has none those of its faces
/// if it says so (TriangleMesh::is_flat), else means over the faces around a vertex, weighted by
/// their angles there (Thuermer and Wuethrich, Computing vertex normals from polygonal facets,
/// 1998), parted at edges that fold by more than 30 degrees. Vertices of equal position are one.
/// Corners of faces without area get what is there, at worst (0, 0, 1).
std::vector<std::array<Vec3, 3>> shading_normals(const TriangleMesh& mesh);

}  // namespace onmesh
