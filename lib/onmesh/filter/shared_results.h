// The mean of several places' results where they share a texel.
#pragma once

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

  /// The targets concerned, ascending.
  const std::vector<Index>& targets() const { return shared_; }
  /// \param position in targets()
  /// \param values one per channel
  void keep(std::size_t position, const float* values);

  /// Once all are kept: call write(texel, values) for every texel with the mean of its results,
  /// weighted by their areas.
  void merge(const std::function<void(Index texel, const float* values)>& write) const;

 private:
  const Samples& targets_;
  std::size_t channels_;
  std::vector<Index> shared_;
  std::vector<float> values_;
};

}  // namespace onmesh
