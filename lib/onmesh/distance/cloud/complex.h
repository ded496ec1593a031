// The triangle complex of a point cloud: its local triangulations in one.
#pragma once

#include <vector>

#include "onmesh/distance/cloud/point_cloud.h"

namespace onmesh::cloud {

/// Complexes on the patch's nodes for the heat solver.
struct Complex {
  Patch triangles;             ///< the cloud's triangles
  Patch cover;                 ///< the same, intrinsic Delaunay: see flip_tufted_cover()
  std::vector<float> weights;  ///< per face of the cover; empty = 1 each
};

/// The local triangulations around all points in one complex. A triangle that all its corners found
/// is in. Where they disagree, gaps are filled with what fits: nothing lies twice on one side of an
/// edge. What the patch's faces join stays joined.
/// \param patch without bridges
Complex make_complex(const Patch& patch, const NodeGeometry& geometry);

}  // namespace onmesh::cloud
