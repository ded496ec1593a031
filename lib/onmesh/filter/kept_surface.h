// What a filter makes of mesh and atlas before it looks at values.
#pragma once

#include <memory>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/distance/backend.h"
#include "onmesh/filter/draw_samples.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/setup.h"
#include "onmesh/filter/stages.h"
#include "onmesh/filter/surface_textures.h"

namespace onmesh {

/// Nodes, samples and where distances come from: the same for all values on the surface, and all
/// ways to compare them. The back end refers to the others, so that it stays where it is.
struct KeptSurface {
  KeptSurface() = default;
  KeptSurface(const KeptSurface&) = delete;
  KeptSurface& operator=(const KeptSurface&) = delete;

  FilterSetup setup;
  NodeSurface nodes;
  FilterSamples samples;  ///< weighed by area alone
  std::unique_ptr<DistanceBackend> backend;
  FilterReport report;  ///< what is known so far
};

/// \param images receive copies of the textures, made meanwhile, unless null
/// \throw as filter(), but for what is wrong with values
std::unique_ptr<KeptSurface> make_kept_surface(const TriangleMesh& mesh,
                                               const SurfaceTextures& textures,
                                               const FilterOptions& options,
                                               const Progress& progress,
                                               std::vector<Image>* images = nullptr);

}  // namespace onmesh
