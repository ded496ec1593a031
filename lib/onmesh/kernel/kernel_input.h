// What the kernel sums over and what it counts, the same for direct sums and for sums on nodes.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "onmesh/distance/distance_table.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

struct KernelOptions {
  double sigma_spatial = 0;  ///< mesh units, > 0
  double radius = 0;         ///< mesh units, > 0: which pairs count, see largest_squared()
  double sigma_range = 0;    ///< value units; 0 = Gaussian filter (no range weight)
};

/// Colours of the texels: `channels` values each, which are averaged. The first `range_channels`
/// floats of a texel take part in the colour difference (at least one unless the filter is
/// Gaussian): values themselves, or features that come before them.
struct Colours {
  const float* floats = nullptr;
  int channels = 0;
  int range_channels = 0;
  int stride = 0;       ///< floats from one texel to the next
  int width = 1;        ///< texels in a row of the texture: tells which are near each other
  int first_value = 0;  ///< features before the values; 0: values are compared

  /// Floats of a texel that count.
  int fields() const { return first_value + channels; }
  const float* of(Index texel) const { return floats + std::size_t(texel) * std::size_t(stride); }
  const float* values_of(Index texel) const { return of(texel) + first_value; }
};

/// Scaled colours beyond this would overflow when squared and summed.
inline constexpr float kLargestColour = 1e15F;

/// Whether a texel's floats can be summed: finite, and small enough to be squared once scaled.
inline bool is_usable(const float* colour, int fields, float scale) {
  bool usable = true;  // comparisons with NaN fail
  for (int c = 0; c < fields; ++c) usable &= std::abs(colour[c] * scale) < kLargestColour;
  return usable;
}

/// Samples and targets of one patch by global face, with its table.
///
/// The targets of the core faces are numbered by slots: core face 0's come first, then core face
/// 1's, ... Results are in their order.
struct KernelInput {
  const Patch* patch = nullptr;
  const DistanceTable* table = nullptr;
  const Samples* sources = nullptr;  ///< what is summed over
  const Samples* targets = nullptr;  ///< where the result is wanted
  Colours colours;
  /// Which targets to filter, per slot; null: all. The others' results are left as they are.
  const std::vector<unsigned char>* only = nullptr;
  /// Targets whose values are not finite get the mean by what is compared of them; else they keep
  /// their values. (Of the direct sums; without a range term it is always so.)
  bool fills = false;
};

/// \param is_source per row (or as many as are given): whether it takes part
/// \return per column the smallest entry of these rows
std::vector<float> nearest_squared(const DistanceTable& table,
                                   const std::vector<unsigned char>& is_source);

/// \return per core face the slot of its first target, then the number of all targets
std::vector<Index> first_slots(const KernelInput& input);

struct KernelCounts {
  std::uint64_t pairs = 0;           ///< (target, sample) pairs within the radius
  std::uint64_t without_sample = 0;  ///< targets that kept their own texel's values
};

}  // namespace onmesh
