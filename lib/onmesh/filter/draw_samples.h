// What the filter sums over, and where its results go.
#pragma once

#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/setup.h"
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

/// Weigh the sources by their texels' alpha: what cannot be seen has no colour. Where all are
/// opaque nothing changes.
void weigh_by_alpha(const SurfaceTextures& textures, FilterSamples& samples);

}  // namespace onmesh
