// Fans: the faces at a vertex that edges join there.
#pragma once

#include <vector>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/edge_table.h"

namespace onmesh {

/// The fans of every vertex, as sets of corners (3 * face + 0..2): faces at a vertex that are
/// joined by edges there.
/// \param edges of the mesh
DisjointSets join_fans(const TriangleMesh& mesh, const EdgeTable& edges);

/// The number of fans of every vertex; more than one makes a bow tie.
/// \param fans as join_fans() gives them
std::vector<Index> count_fans(const TriangleMesh& mesh, DisjointSets& fans);

}  // namespace onmesh
