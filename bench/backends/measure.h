// One distance back end on one scene: errors, filter quality, time, memory.
#pragma once

#include <limits>

#include "backends/observer.h"
#include "backends/scene.h"
#include "onmesh/measure/distance_error.h"

namespace onmesh::bench {

/// Lengths in units of sigma. NaN = not measured.
struct Row {
  static constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();
  std::string mesh, backend;
  double sigma_texels = 0;
  double spacing = 0;  ///< the filter's node spacing on smooth surface
  std::size_t faces = 0, texels = 0, nodes = 0;
  std::string skipped;  ///< why there are no numbers, empty if there are
  /// Of what the kernel sees: distances between texels, interpolated from the table, within the
  /// bilateral filter's radius.
  DistanceError error;
  /// Of the table's entries: distances between nodes within that radius.
  DistanceError node_error;
  double psnr_gaussian = kUnmeasured, psnr_bilateral = kUnmeasured;  ///< dB
  double refine_ms = kUnmeasured;  ///< making the nodes (the same for all back ends)
  Cost cost;
};

/// The table filled with true distances: what interpolation alone costs. Fills `truth`.
Row measure_exact(const Scene& scene, NodeTruth& truth);

/// A back end as filter() runs it. Times are medians of `repeats` runs on one thread (CPU time).
/// A back end that throws gives a skipped row.
Row measure_backend(const Scene& scene, DistanceMethod method, const NodeTruth& truth, int repeats);

/// Straight lines through space instead of geodesics.
Row measure_euclidean(const Scene& scene, const NodeTruth& truth);

}  // namespace onmesh::bench
