// Medians of several channels at once, of a few texels.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// Computes them, keeping its buffers. One object per thread.
class Medians {
 public:
  /// \pre colours outlives this
  explicit Medians(const Colours& colours) : colours_(colours) {}

  /// The median of each channel over a texel and those around it; of an even number the mean of the
  /// two in the middle. Values that are not finite do not count.
  /// \param out one value per channel; NaN where none counts
  void find(Index texel, std::span<const Index> around, float* out);

 private:
  using Exchange = std::pair<unsigned char, unsigned char>;

  bool find_by_network(Index texel, std::span<const Index> around, float* out);
  void find_one(Index texel, std::span<const Index> around, std::size_t channel, float* out);
  const std::vector<Exchange>& network(std::size_t count);

  const Colours& colours_;
  std::vector<std::vector<Exchange>> networks_;  ///< by how many values they sort
  std::vector<float> values_;
};

}  // namespace onmesh
