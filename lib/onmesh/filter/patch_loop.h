// The filter's main loop: distances and kernel, patch by patch, in parallel.
#pragma once

#include <cstdint>
#include <functional>

#include "onmesh/distance/backend.h"
#include "onmesh/filter/options.h"
#include "onmesh/kernel/checked_kernel.h"
#include "onmesh/kernel/direct/direct_kernel.h"

namespace onmesh {

/// Everything the patches read. All pointers must be set.
struct PatchWork {
  const NodeMesh* nodes = nullptr;
  const DistanceBackend* backend = nullptr;
  const Samples* sources = nullptr;
  const Samples* targets = nullptr;
  Colours colours;
  KernelOptions kernel;
  FilterMethod method = FilterMethod::direct;
  double tolerance = 0;  ///< of codes, > 0; not for FilterMethod::direct
  EncodeValues encode;   ///< from values to codes, which errors are measured in; empty = the same
  bool has_missing = false;  ///< some targets have no value: they get the mean around them
  int shared_features = 0;   ///< so many of the first features do not come from own values
  /// Node faces with a sample so far from all others that sums on nodes would lose those beside it;
  /// empty = none.
  std::vector<bool> hot_faces;
};

struct PatchCounts {
  std::uint64_t patches = 0, pairs = 0, without_sample = 0, table_rows = 0;
  /// Pairs within the radius, whether they were summed or not; estimated where the nodes were used.
  double pairs_within = 0;
  double table_cpu_seconds = 0, kernel_cpu_seconds = 0;
  NodeCheck nodes;

  void add(const PatchCounts& other);
};

/// Takes the results of the targets with these positions in PatchWork::targets->samples: as many
/// values as there are channels for each.
using StoreResults = std::function<void(Index begin, Index end, const float* values)>;

/// Filter all targets. How they are grouped into patches does not depend on the number of threads.
/// \param store called from any thread; every target once
/// \param progress called with the share that is done (0 to 1), never twice at once; may be empty
PatchCounts filter_patches(const PatchWork& work, const StoreResults& store,
                           const std::function<void(double)>& progress);

/// CPU seconds that `work` will need for its distances, from timing one small patch.
double estimate_table_seconds(const PatchWork& work);

}  // namespace onmesh
