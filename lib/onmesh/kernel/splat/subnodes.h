// Subnodes: the nodes of a patch and the midpoints of its longer edges.
#pragma once

#include <vector>

#include "onmesh/distance/backend.h"

namespace onmesh {

/// A patch's faces split 1 -> 4 where they are coarse. Subnodes that are nodes come first, with the
/// same numbers; then one per edge. Distances between subnodes need no solving: they follow from
/// the node table by the formula that serves all points of faces.
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

/// Subnodes where edges are longer than `longest`.
Subnodes make_subnodes(const Patch& patch, double longest);

/// The weights of a Gaussian from every core subnode to the real subnodes around it, as powers of
/// two (CSR over Subnodes::core).
struct BlurWeights {
  std::vector<std::size_t> offsets;
  std::vector<Index> subnodes;
  std::vector<float> exponents;
};

/// log2 of exp(-d^2 / 2 s^2) for d <= radius, where s^2 is sigma^2 less what interpolation to and
/// from the subnodes blurs by itself: the mean of both subnodes' variances. \pre sigma^2 is more
/// than any subnode's variance
BlurWeights make_blur(const Patch& patch, const DistanceTable& table, const Subnodes& subnodes,
                      double sigma, double radius);

}  // namespace onmesh
