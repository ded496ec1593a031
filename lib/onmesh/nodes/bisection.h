// Refinement of any triangle complex into nodes: bisection inside the input's faces.
#pragma once

#include "onmesh/nodes/refine.h"

namespace onmesh {

/// Refine by longest-edge bisection (Rivara 1984: the longest-edge propagation path): a face that
/// is too large is split at the middle of its longest edge together with all other faces on that
/// edge, after those whose own longest edge is another one have been split there. So the result is
/// conforming over edges of any number of faces, node faces never leave their input face, and an
/// angle shrinks to half the input's least one at worst. A face is too large when its longest edge
/// exceeds 1.4 times the wanted spacing, which on right isosceles faces is the circumradius bound
/// of the intrinsic refinement. The wanted spacing is also that one's; at a vertex that is not
/// manifold the bend is read off its link (a graph of the faces around it): how far the shortest
/// cycle through a face is from 2 pi, and how far the link reaches beyond pi. Pages on a straight
/// spine have none, as any two of them make a flat sheet; the tip of a bow tie, which all paths
/// from one part to the other pass, has the largest.
///
/// Works on any mesh without repeated vertices in a face: edges with many faces, bow ties,
/// one-sided or inconsistently wound parts, faces without area. Input vertices stay nodes with
/// their indices. The time is linear in the nodes made. \throw UsageError if the spacing is not
/// positive and finite \throw InputError if more than max_nodes would be needed
/// RefineOptions::min_angle_degrees has no meaning here; RefineReport::flips is 0.
NodeSurface refine_soup(const TriangleMesh& mesh, const RefineOptions& options,
                        RefineReport* report = nullptr);

}  // namespace onmesh
