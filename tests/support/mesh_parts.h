// Meshes from other meshes, and points on them.
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// [0,1]^2 in n x n cells of two triangles, UV = position * scale + offset.
TriangleMesh textured_square(int n, const Vec2& scale = {1, 1}, const Vec2& offset = {0, 0});

/// Both meshes, the second one moved, as one that is not joined: first the first one's vertices,
/// UVs and faces, then the second one's. Materials are those of the first.
TriangleMesh side_by_side(const TriangleMesh& first, const TriangleMesh& second,
                          const Vec3& move = Vec3::Zero());

/// Points of the surface, all equally likely.
std::vector<SurfacePoint> random_points(const TriangleMesh& mesh, int count, unsigned seed);

}  // namespace onmesh
