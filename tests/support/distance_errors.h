// Errors of distance back ends, for their tests.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "onmesh/distance/distance_table.h"
#include "onmesh/distance/exact.h"
#include "onmesh/patches/grow_patch.h"
#include "onmesh/patches/partition.h"

namespace onmesh {

double mean_edge(const NodeMesh& mesh);

/// The whole mesh as one patch, nodes with their own numbers.
Patch whole(const NodeMesh& mesh);

DistanceTable fill(const DistanceBackend& backend, const Patch& patch, const Reach& reach);
/// With the radius as far as the reach.
DistanceTable fill(const DistanceBackend& backend, const Patch& patch, double reach);

struct Errors {
  double mean = 0, p99 = 0, max = 0;
  std::size_t count = 0;
};

/// \throw std::logic_error if there are none
Errors summarise(std::vector<double> errors);

/// |d - truth| for all pairs up to `reach`.
/// \throw std::logic_error if one of them was not reached
Errors compare(const DistanceTable& table, double reach,
               const std::function<double(Index, Index)>& truth);

/// Errors of a back end against exact distances in units of the mean edge length, for every
/// `stride`-th node, as the filter would ask: patch by patch.
/// \throw std::logic_error if a node within reach was not reached
Errors against_exact(const DistanceBackend& backend, const TriangleMesh& mesh, double radius,
                     Index stride);

}  // namespace onmesh
