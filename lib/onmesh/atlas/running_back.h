// Columns of faces that run back over the whole texture (internal).
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Number of faces whose UVs run back to the other end of their chart: mirrored beside the rest of
/// the chart, at least half as wide or high as the chart, and four times as much as half of its
/// faces are. So is the last column of a closed wrap whose vertices at the seam have only the UVs
/// of the texture's start, not those of its end.
/// \param chart_of_face as find_charts() has it; kNone where a face holds no texels
Index count_running_back(const TriangleMesh& mesh, const std::vector<Index>& chart_of_face);

}  // namespace onmesh
