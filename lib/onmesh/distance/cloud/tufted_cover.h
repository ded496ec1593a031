// The tufted cover: an intrinsic Delaunay complex of any set of triangles.
#pragma once

#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh::cloud {

/// Make a complex intrinsic Delaunay (Sharp & Crane, A Laplacian for Nonmanifold Triangle Meshes,
/// 2020): two copies of each face, front and back, are glued around every edge in turn, so that
/// every edge has two sides (the tufted cover), and edges are flipped. A face of which no copy was
/// flipped stays one face: the solution is the same on both sides of the cover there. The others'
/// copies are faces of weight 1/2.
/// \param complex corners and lengths are changed; edges are told apart by their nodes
/// \return weights per face; empty if nothing had to be flipped
std::vector<float> flip_tufted_cover(Patch& complex);

}  // namespace onmesh::cloud
