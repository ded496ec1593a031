// The bilateral kernel: sums over samples, weighted by geodesic distance and colour difference.
#pragma once

#include <vector>

#include "onmesh/distance.h"
#include "onmesh/samples.h"

namespace onmesh {

struct KernelOptions {
  double sigma_spatial = 0;  ///< mesh units, > 0
  double radius = 0;         ///< mesh units, > 0: pairs with d^2 <= radius^2 (1 + 1e-5) count
  double sigma_range = 0;    ///< value units; 0 = Gaussian filter (no range weight)
};

/// Colours of the samples: `channels` values per texel. Only the first `range_channels` take part in
/// the colour difference; all are averaged.
struct Colours {
  const float* values = nullptr;
  int channels = 0;
  int stride = 0;           ///< floats from one texel to the next
};

/// Samples and targets of one patch by local face, with its table.
struct KernelInput {
  const Patch* patch = nullptr;
  const DistanceTable* table = nullptr;
  const Samples* sources = nullptr;  ///< what is summed over (by global face)
  const Samples* targets = nullptr;  ///< where the result is wanted (by global face)
  Colours colours;
};

/// Filter all targets in the patch's core faces.
/// \param out `channels` values per target, for core face 0's targets first, then core face 1's, ...
///   in the order of `targets`; a target whose weights sum to nothing gets its own texel's values
/// \return number of pairs within the radius
std::uint64_t filter_patch(const KernelInput& input, const KernelOptions& options, std::vector<float>& out);

/// The instruction set chosen at run time ("AVX3", "AVX2", ...).
const char* kernel_target();

}  // namespace onmesh
