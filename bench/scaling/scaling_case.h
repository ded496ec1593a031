// One measurement of the whole filter: on what, how, and what is counted.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "onmesh/filter/filter.h"

namespace onmesh::bench {

struct ScalingCase {
  std::string family;  ///< which scaling it belongs to
  std::string shape;
  std::function<TriangleMesh()> mesh;
  int faces = 0;     ///< about as many; part of the name where it is not 0
  int size = 0;      ///< texels per side of the texture
  double sigma = 8;  ///< texels
  FilterMethod method = FilterMethod::automatic;
  int threads = 1;

  /// family/shape:.../size:...: what is needed to tell it from others.
  std::string name() const;
  /// Pairs of a target and a sample if the texture is fully covered: what direct sums and OpenCV
  /// cost.
  double pairs() const;
  /// Long runs are done once.
  int repetitions() const;
};

/// Direct sums and 2D filters of more pairs would take minutes; they are left out.
inline constexpr double kMostPairs = 1e11;

/// Runs the filter and sets the counters:
/// compute_seconds (all stages, no image is read or written), *_seconds (the stages), faces,
/// texels, nodes, taps (samples within the radius per texel), Mtexel_per_s, share_by_nodes,
/// palette, rms_error; memory_bytes (peak of the process), bytes_per_texel (peak less what was
/// there before, input and output: per texel of the texture); opencv_seconds (2D filter of a
/// texture of that size and radius), opencv_scaled_seconds (the same at as many pairs), ratio
/// (compute to that).
void run_scaling_case(benchmark::State& state, const ScalingCase& scaling_case);

}  // namespace onmesh::bench
