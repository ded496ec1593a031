// Small meshes for the tests of the texel side.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A mesh in the xy plane that equals its UVs, times `scale`.
TriangleMesh flat(const std::vector<Vec2>& uvs, const std::vector<std::array<Index, 3>>& faces,
                  double scale = 1);

/// The v, vt and f lines of an OBJ file, equal positions and UVs merged; empty if there is none.
TriangleMesh read_data(const std::string& name);

}  // namespace onmesh
