// What the filter sums over, and where its results go.
#pragma once

#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/setup.h"
#include "onmesh/image/texel_values.h"
#include "onmesh/kernel/direct/direct_kernel.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Sources and targets, sorted into node faces.
struct FilterSamples {
  Samples sources;               ///< what is summed over
  bool targets_are_own = false;  ///< else the targets are the sources
  Samples own_targets;           ///< where results go, if not to the sources
  const Samples& targets() const { return targets_are_own ? own_targets : sources; }
};

/// Samples as `options.samples` says; targets as the overlap policy does.
/// \param surface the nodes of setup.mesh
FilterSamples draw_samples(const FilterSetup& setup, const NodeSurface& surface,
                           const FilterOptions& options, const Progress& progress);

/// How much the texels of samples count.
struct SampleWeights {
  std::vector<float> of_mask;  ///< per texel, see chart_mask(); empty = all 1
  /// What cannot be seen has no colour.
  bool by_alpha = false;
  /// The textures' own values.
  ConstTexelValues codes;

  bool are_one() const { return of_mask.empty() && !(by_alpha && codes.alpha_channel() >= 0); }
  float of(Index texel) const;
};

/// Weigh the sources. Where all weights are 1 nothing changes.
void weigh_samples(const SampleWeights& weights, FilterSamples& samples);

}  // namespace onmesh
