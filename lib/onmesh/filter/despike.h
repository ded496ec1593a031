// Values that stick out of those around them, taken down before anything is averaged.
#pragma once

#include <cstdint>

#include "onmesh/filter/near_texels.h"
#include "onmesh/filter/working_values.h"

namespace onmesh {

/// See despike().
struct DespikeOptions {
  double factor = 0;      ///< K, > 0
  bool to_limit = false;  ///< colours come down to the limit, not to the median
};

/// What was changed.
struct DespikeReport {
  std::uint64_t spikes = 0;  ///< texels, each once
  /// Means over the surface, of luminance or of all channels of data.
  double mean_before = 0, mean_after = 0;
};

/// Take down spikes of all maps.
///
/// A texel is judged by the covered texels within three texels (of its own width) along the
/// surface, if there are six at least; all are judged by what was read. P80 is their 80th
/// percentile. Colours are a spike if their luminance exceeds K P80 + .001 Lavg, Lavg the
/// log-average over the surface: they are scaled to the median luminance around,
/// or to that limit if options say so. A channel of data
/// is one if |v - median| exceeds K P80(|neighbour - median|) + .001 of the robust range of values:
/// it becomes the median. Percentiles between two values are interpolated.
/// \param work what counts as a neighbour, with areas, and who is judged
DespikeReport despike(const NearWork& work, const DespikeOptions& options, WorkingValues& working);

}  // namespace onmesh
