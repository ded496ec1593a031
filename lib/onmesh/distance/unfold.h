// The virtual-source march: distances by unfolding face after face.
#pragma once

#include <memory>

#include "onmesh/distance/backend.h"

namespace onmesh {

/// Distances that spread from node to node. At each face the source is placed in the face's plane
/// by its distances from two corners (the virtual source); the third corner gets the straight line
/// to it if that crosses the edge between the two, else the shorter way along an edge (Melvaer &
/// Reimers, Geodesic polar coordinates on polygonal meshes, 2012, after Reimers, Topics in mesh
/// based modelling, 2004). Where the surface unfolds into a plane, distances are exact but for
/// rounding; only beyond a cone, where a node's shortest ways from several sides meet, one virtual
/// source is too little to tell.
///
/// Our own are the order, by a queue that takes a node again whenever it came closer (label
/// correcting), so that one march serves 16 sources, one per SIMD lane; and that all is done on
/// squares. The queue is a plain one until nodes were visited many times, as beside needles; then
/// it is a heap.
std::unique_ptr<DistanceBackend> make_unfold();

}  // namespace onmesh
