// The Gaussian that sums on subnodes are blurred by.
#pragma once

#include <vector>

#include "onmesh/distance/distance_table.h"
#include "onmesh/kernel/splat/subnodes.h"

namespace onmesh {

/// The weights from every core subnode to the real subnodes around it (CSR over Subnodes::core).
struct BlurWeights {
  std::vector<std::size_t> offsets;
  std::vector<Index> subnodes;
  std::vector<float> weights;  ///< padded to whole vectors
};

/// exp(-d^2 / 2 s^2) for d within the radius, where s^2 is sigma^2 less what interpolation to and
/// from the subnodes blurs by itself: the mean of both subnodes' variances.
///
/// A subnode is the middle of an edge (or of a node with itself), so that d^2 = sum_ij a_i b_j D_ij
/// - V(x) - V(y) (derived in lib/README.md) is the mean of the table's entries between both edges'
/// ends, less a quarter of their squared lengths.
/// \pre sigma^2 is more than any subnode's variance
BlurWeights make_blur(const Patch& patch, const DistanceTable& table, const Subnodes& subnodes,
                      double sigma, double radius);

/// \return per subnode whether the blur reads it, directly or through the ends of an edge too short
///   to split
std::vector<unsigned char> subnodes_read(const Subnodes& subnodes, const BlurWeights& blur);

}  // namespace onmesh
