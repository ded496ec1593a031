// The heat method on a patch: the back end, and the solver that it shares with the point cloud's.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/distance/backend.h"

namespace onmesh {

/// The heat method (Crane, Weischedel & Wardetzky, Geodesics in heat, 2013) on one patch, with
/// local factorisations, 16 sources at a time.
///
/// At this range, a few node spacings, the method as published is no better than Euclidean
/// distance. What makes it accurate here is our own:
/// - The patch is split 1 -> 4 (intrinsically: edge lengths halve), which quarters the time step t.
/// - Its error is first order in sqrt(t), so the divergence is extrapolated from t and 4 t:
///   2 div(t) - div(4 t) (Richardson). Both are linear up to the one Poisson solve, so that costs
///   one heat solve.
/// - The near field comes from the virtual-source march on the same complex, to which the rest is
///   fitted along every ray (calibration.h).
std::unique_ptr<DistanceBackend> make_heat();

}  // namespace onmesh

namespace onmesh::heat {

/// How far beyond `reach` a complex must extend: what its rim bends, which neither reflects heat
/// nor lets it pass altogether, must stay outside. Mesh units.
double margin(double longest_edge);

/// Squared distances from every core node to every node (see DistanceBackend::fill). Both complexes
/// are on the same nodes; they may be the same. Any triangle complex will do: faces may overlap,
/// share all their nodes, or have a node twice. Edges of equal nodes and length are one edge unless
/// the gluing says otherwise.
/// \param near what the near field is marched on: as much like the surface as possible
/// \param flow what heat flows on: as much Delaunay as possible
/// \param weights per face of flow: how many layers of surface it stands for; empty = 1 each
/// \return false if a matrix cannot be factorised: then all distances are those of unfolding `near`
bool fill(const Patch& near, const Patch& flow, const std::vector<float>& weights,
          const Reach& reach, DistanceTable& table);

}  // namespace onmesh::heat
