// The partition of a node mesh's faces into groups, each the core of a patch.
#pragma once

#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh {

/// Group the faces that carry targets into compact groups of about equal weight, each connected
/// over shared nodes. Faces of weight 0 are in no group. Deterministic; O(faces log groups).
///
/// This is recursive graph bisection (Simon, Partitioning of unstructured problems for parallel
/// processing, 1991): the graph is split between two of its farthest ends by hop distance, then
/// each part again. Three things are our own: what is split are clusters of up to eight faces,
/// several times faster than faces; they are ordered by the difference of the distances to both
/// ends, which makes the cut short and straight; and groups that come out small are merged into a
/// neighbour.
/// \param weights one per face, >= 0: how much work its targets are, in any unit
/// \param target_weight of a group, > 0. Groups weigh at most 1.5 times that unless a face alone
///   weighs more
/// \pre mesh.build_incidence() was called
/// \return groups of faces, ascending within a group
std::vector<std::vector<Index>> partition_faces(const NodeMesh& mesh,
                                                const std::vector<double>& weights,
                                                double target_weight);

/// The core of a patch that is too large in two compact groups or a few more, of about half as many
/// faces each. Deterministic.
/// \pre the core has two faces or more
/// \return groups of global faces, ascending within a group
std::vector<std::vector<Index>> split_core(const Patch& patch);

}  // namespace onmesh
