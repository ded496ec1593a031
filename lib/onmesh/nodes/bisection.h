// Refinement of any triangle complex into nodes: bisection inside the input's faces.
#pragma once

#include "onmesh/nodes/refine.h"

namespace onmesh {

/// Refine by longest-edge bisection along the longest-edge propagation path (Rivara, New
/// longest-edge algorithms for the refinement and/or improvement of unstructured triangulations,
/// 1997): a face that is too large is split at the middle of its longest edge together with all
/// other faces on that edge, after those whose own longest edge is another one have been split
/// there. So the result is conforming over edges of any number of faces, node faces never leave
/// their input face, and an angle shrinks to half the input's least one at worst (Rosenberg &
/// Stenger 1975).
///
/// A face is too large when its longest edge exceeds 1.4 times the wanted spacing (sizing_field.h),
/// which on right isosceles faces is the circumradius bound of the intrinsic refinement.
///
/// Works on any mesh without repeated vertices in a face: edges with many faces, bow ties,
/// one-sided or inconsistently wound parts, faces without area. Input vertices stay nodes with
/// their indices. The time is linear in the nodes made. RefineOptions::min_angle_degrees has no
/// meaning here; RefineReport::flips is 0.
/// \throw OptionError for options outside their domain
/// \throw TooManyNodes if more than options.max_nodes would be needed; beside lengths of 1 : 10^16
///   rounding can let it go on
NodeSurface refine_by_bisection(const TriangleMesh& mesh, const RefineOptions& options,
                                RefineReport* report = nullptr);

}  // namespace onmesh
