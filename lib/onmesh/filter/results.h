// From the kernel's results to the image.
#pragma once

#include <vector>

#include "onmesh/filter/shared_results.h"
#include "onmesh/filter/working_values.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// Smallest and largest working value per colour channel of what is filtered.
struct ValueRange {
  std::vector<float> lowest, highest;  ///< infinite where no value is finite
};

/// The range of all values that a texel may end up with: those of the samples, and those of the
/// targets, which may keep theirs. Colours of texels whose alpha is 0 are neither.
/// \param sources the samples, if others than the covered texels are summed over; else null
/// \return of what WorkingValues::straighten() leaves
ValueRange value_range(const WorkingValues& working, const Samples* sources);

/// How far the texels' codes go without rare ones: from below the 99.9th percentile over the
/// surface to above the 0.1th, of all channels; at least 1e-6 of the largest; 1 if all are 0.
double robust_extent(const ConstTexelValues& codes, const TexelMap& map);
/// The same of some channels.
double robust_extent(const ConstTexelValues& codes, const std::vector<int>& channels,
                     const TexelMap& map);
/// The same of colours or features.
double robust_extent(const Colours& colours, const TexelMap& map);

/// Node faces with a sample that is farther from the texels' robust range of values than that is
/// wide.
/// \return one entry per node face, or none at all if there is no such sample
std::vector<bool> hot_faces(const Colours& colours, const TexelMap& map, const Samples& sources);

/// Takes the kernel's results and puts them into the images, straight. Every texel is written by
/// one thread: those with several claims wait in a list of their own until all are there.
class Results {
 public:
  /// \param working what was summed
  /// \param texels of copies of the textures, to be written; the colours of those with alpha 0 are
  ///   not
  /// \param range that results are clamped to, against rounding
  /// \pre all but range outlives this
  Results(const OverlapPolicy& overlap, const Samples& targets, const WorkingValues& working,
          ValueRange range, const TexelValues& texels);

  /// As StoreResults.
  void store(Index begin, Index end, const float* values);
  /// Once all are stored: write the texels that have several claims.
  void merge_shared();

 private:
  void write(Index texel, const float* values);

  const Samples& targets_;
  const WorkingValues& working_;
  const ValueRange range_;
  const TexelValues texels_;
  SharedResults shared_;
};

}  // namespace onmesh
