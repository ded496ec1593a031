// The heat method on a patch-sized triangle complex: the solver that mesh heat and cloud heat
// share.
#pragma once

#include <vector>

#include "onmesh/distance.h"

namespace onmesh::heat {

/// How far beyond `reach` a complex must extend: its rim reflects heat, and what that bends must
/// stay outside.
double margin(double longest_edge);

/// Squared distances from every core node to every node (see DistanceBackend::fill).
/// \param complex any triangle complex; faces may overlap, share all their nodes, or have a node
///   twice. Edges of equal nodes and length are one edge unless the gluing says otherwise.
/// \param weights per face: how many layers of surface it stands for; empty = 1 each
void fill(const Patch& complex, const std::vector<float>& weights, double reach,
          DistanceTable& table);

}  // namespace onmesh::heat
