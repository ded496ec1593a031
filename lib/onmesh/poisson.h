// Poisson-disk samples of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/progress.h"
#include "onmesh/triangle_mesh.h"

namespace onmesh {

struct PoissonOptions {
  double spacing = 0;      ///< minimum distance of two samples, mesh units, > 0
  std::uint64_t seed = 1;
  std::vector<bool> faces; ///< faces to sample; empty = all with area
};

/// Random samples (CGAL) eliminated to a minimum spacing, then filled up until maximal.
///
/// Two samples conflict when they are closer than the spacing in space *and* joined by surface within
/// the ball of that radius around one of them; so the two sides of a thin sheet don't thin each other
/// out. The set is maximal: every point of the sampled surface has a sample it conflicts with, up to
/// 1e-3 of the spacing. Same options, same samples, on any machine and thread count.
/// \throw InputError if the spacing would need more than 2^28 samples
std::vector<SurfacePoint> poisson_samples(const TriangleMesh& mesh, const PoissonOptions& options,
                                          const Progress& progress = {});

}  // namespace onmesh
