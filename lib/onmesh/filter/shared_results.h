// The mean of several places' results where they share a texel.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "onmesh/atlas/overlap.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Keeps the results of targets whose texels have several until all are there. Targets that are
/// different may be kept from different threads at once.
class SharedResults {
 public:
  /// \param targets every claim of the map, or the first ones, as OverlapPolicy has it
  SharedResults(const OverlapPolicy& policy, const Samples& targets, std::size_t channels);

  /// Keep those of some targets, and call write(target, values) for the others.
  /// \param values of targets begin, begin + 1, ...
  template <class Write>
  void store(Index begin, Index end, const float* values, const Write& write) {
    auto next = std::lower_bound(shared_.begin(), shared_.end(), begin);
    for (Index target = begin; target < end; ++target, values += channels_) {
      if (next != shared_.end() && *next == target) {
        keep(std::size_t(next - shared_.begin()), values);
        ++next;
      } else {
        write(target, values);
      }
    }
  }

  /// Once all are kept: call write(texel, values) for every texel with the mean of its results,
  /// weighted by their areas.
  void merge(const std::function<void(Index texel, const float* values)>& write) const;

 private:
  void keep(std::size_t position, const float* values);

  const Samples& targets_;
  std::size_t channels_;
  std::vector<Index> shared_;  ///< the targets concerned, ascending
  std::vector<float> values_;
};

}  // namespace onmesh
