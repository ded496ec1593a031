// The overlay of an intrinsic triangulation and the input mesh that it lies on.
#pragma once

#include "onmesh/base/error.h"
#include "onmesh/nodes/intrinsic_triangulation.h"
#include "onmesh/nodes/overlay.h"

namespace onmesh {

/// An overlay would need more memory than goes with the meshes that it is of.
struct TooManyPieces : InputError {
  using InputError::InputError;
};

/// Lay out, in the plane of each input face, the intrinsic faces that overlap it: starting at a
/// corner by the signposts, then from face to face over every edge that runs through the input
/// face. Unfolding is an isometry there because the inside of an input face holds no cone. Linear
/// in the pieces.
/// \throw TooManyPieces if these are many times the faces of both meshes
Overlay make_overlay(const IntrinsicTriangulation& triangulation);

}  // namespace onmesh
