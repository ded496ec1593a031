// From the kernel's results to the image.
#pragma once

#include <vector>

#include "onmesh/filter/shared_results.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// Smallest and largest value per colour channel of what is filtered, in value units.
struct ValueRange {
  std::vector<float> lowest, highest;  ///< infinite where no value is finite

  /// Of all channels: the largest less the smallest value; 1 if all are equal.
  double extent() const;
};

/// The range of all values that a texel may end up with: those of the samples, and those of the
/// targets, which may keep theirs.
/// \param sources the samples, if others than the covered texels are summed over; else null
ValueRange value_range(const ConstTexelValues& texels, const TexelMap& map, const Samples* sources);

/// Takes the kernel's results and puts them into the images. Every texel is written by one thread:
/// those with several claims wait in a list of their own until all are there.
class Results {
 public:
  /// \param texels of a copy of the textures, to be written
  /// \param range that results are clamped to, against rounding
  /// \pre targets and the images outlive this
  Results(const OverlapPolicy& overlap, const Samples& targets, ValueRange range,
          const TexelValues& texels);

  /// As StoreResults.
  void store(Index begin, Index end, const float* values);
  /// Once all are stored: write the texels that have several claims.
  void merge_shared();

 private:
  void write(Index texel, const float* values);

  const Samples& targets_;
  const ValueRange range_;
  const TexelValues texels_;
  SharedResults shared_;
};

}  // namespace onmesh
