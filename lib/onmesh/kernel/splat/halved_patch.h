// A patch with faces of half the size, and its table.
#pragma once

#include "onmesh/distance/distance_table.h"
#include "onmesh/patches/patch.h"

namespace onmesh {

/// Every face of a patch split 1 -> 4 at its edges' midpoints: face f becomes 4 f, ... 4 f + 2 at
/// its corners and 4 f + 3 in the middle, whose corner k is the midpoint opposite corner k. Nodes
/// have other numbers than in the whole patch (and Patch::nodes is left empty but for its size).
/// The table's entries at midpoints follow from those at nodes by the formula that serves all
/// points of faces (derived in lib/README.md): d^2(m) = (d^2(a) + d^2(b)) / 2 - l^2 / 4, where l is
/// the length of the edge from a to b.
struct HalvedPatch {
  Patch patch;
  DistanceTable table;
};

/// \param halved its buffers are used again
/// \pre the patch has no bridges
void halve(const Patch& whole, const DistanceTable& table, HalvedPatch& halved);

}  // namespace onmesh
