// The heat method on a patch-sized triangle complex: the solver that mesh heat and cloud heat
// share.
#pragma once

#include <vector>

#include "onmesh/distance/backend.h"

namespace onmesh::heat {

/// How far beyond `reach` a complex must extend: what its rim bends, which neither reflects heat
/// nor lets it pass altogether, must stay outside.
double margin(double longest_edge);

/// Squared distances from every core node to every node (see DistanceBackend::fill). Both complexes
/// are on the same nodes; they may be the same. Any triangle complex will do: faces may overlap,
/// share all their nodes, or have a node twice. Edges of equal nodes and length are one edge unless
/// the gluing says otherwise.
/// \param near what the near field is marched on: as much like the surface as possible
/// \param flow what heat flows on: as much Delaunay as possible
/// \param weights per face of flow: how many layers of surface it stands for; empty = 1 each
void fill(const Patch& near, const Patch& flow, const std::vector<float>& weights, double reach,
          DistanceTable& table);

}  // namespace onmesh::heat
