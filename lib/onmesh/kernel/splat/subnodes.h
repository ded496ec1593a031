// Subnodes: the nodes of a patch and the midpoints of its longer edges.
#pragma once

#include <array>
#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh {

/// A patch's faces split 1 -> 4 where they are coarse. Subnodes that are nodes come first, with the
/// same numbers; then one per edge. Distances between subnodes need no solving: they follow from
/// the node table, see make_blur().
struct Subnodes {
  /// The nodes whose mean place each subnode is: the same twice, or an edge's ends.
  std::vector<std::array<Index, 2>> ends;
  std::vector<float> squared_length;  ///< of that edge; 0 for nodes
  /// Per subnode; false for midpoints of edges too short to split. Those take no part in sums: they
  /// stand for the mean of their edge's ends.
  std::vector<unsigned char> is_real;
  /// Per subnode: mean over the split faces around it, weighted by area, of the barycentric
  /// variance's mean over the face, (l01^2 + l12^2 + l20^2) / 12.
  std::vector<float> variance;
  std::vector<std::array<Index, 3>> middle;  ///< per local face: subnode in the middle of edge k
  std::vector<unsigned char> is_split;       ///< per local face: some edge of it is
  std::vector<Index> core;                   ///< real subnodes of core faces, by first end

  Index size() const { return Index(ends.size()); }
};

/// \param longest edges beyond are split
Subnodes make_subnodes(const Patch& patch, double longest);

}  // namespace onmesh
