// The filter's sums on a surface that is made ready.
#pragma once

#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/kept_surface.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Values in, values out.
/// \param mesh as given to make_kept_surface()
/// \param textures of the same layout; settled options that differ in how values are compared and
///   results are used
/// \param is_last nobody needs the surface again: its parts are freed as soon as they are used up
/// \param images copies of the textures
/// \param report already has what the surface says
std::vector<Image> run_on_surface(const TriangleMesh& mesh, const SurfaceTextures& textures,
                                  const FilterOptions& options, KeptSurface& surface, bool is_last,
                                  std::vector<Image> images, FilterReport& report,
                                  const Progress& progress);

}  // namespace onmesh
