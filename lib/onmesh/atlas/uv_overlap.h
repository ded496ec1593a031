// How much of an atlas is used more than once (internal).
#pragma once

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct UvOverlap {
  double share = 0;   ///< of the covered cells, those that more than one face covers
  Index deepest = 0;  ///< most faces on one cell
};

/// Estimate how much of an atlas more than one face uses, texture by texture.
///
/// Counts the faces over each cell centre of a raster over the tile [0,1)^2 that all UVs are
/// wrapped into: 1024 x 1024 cells, fewer if the UVs repeat so often that this would take long. A
/// centre on a shared edge belongs to one face only, so that neighbours don't overlap. Faces whose
/// UVs span more than 64 tiles are left out.
UvOverlap estimate_overlap(const TriangleMesh& mesh);

}  // namespace onmesh
