// The overlay of an intrinsic triangulation and the input mesh that it lies on.
#pragma once

#include "onmesh/nodes/intrinsic_triangulation.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// Lay out, in the plane of each input face, the intrinsic faces that overlap it: starting at a
/// corner by the signposts, then from face to face over every edge that runs through the input
/// face. Unfolding is an isometry there because the inside of an input face holds no cone. Linear
/// in the pieces.
Overlay make_overlay(const IntrinsicTriangulation& triangulation);

}  // namespace onmesh
