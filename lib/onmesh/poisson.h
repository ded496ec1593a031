// Poisson-disk samples of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/progress.h"
#include "onmesh/triangle_mesh.h"

namespace onmesh {

class TexelMap;

struct PoissonOptions {
  double spacing = 0;  ///< minimum distance of two samples, mesh units, > 0
  std::uint64_t seed = 1;
  std::vector<bool> faces;  ///< faces to sample; empty = all with area
};

/// Random samples (CGAL) eliminated to a minimum spacing, then filled up until maximal.
///
/// Two samples conflict when they are closer than the spacing in space *and* joined by surface
/// within the ball of that radius around one of them; so the two sides of a thin sheet don't thin
/// each other out. All faces count as surface there, sampled or not. The set is maximal: every
/// point of the sampled surface has a sample it conflicts with, up to 1e-3 of the spacing. Same
/// options, same samples, on any machine and thread count. On a plane there are about 0.7 /
/// spacing^2 samples per unit of area. \pre mesh is welded \throw UsageError if the spacing is not
/// a positive number \throw InputError if no face to sample has area, or if the spacing would need
/// more than 2^28
///   samples
std::vector<SurfacePoint> poisson_samples(const TriangleMesh& mesh, const PoissonOptions& options,
                                          const Progress& progress = {});

/// Smallest distance of two samples in space, leaving out pairs closer than the spacing that don't
/// conflict because the surface does not join them; infinite if no two are within twice the
/// spacing.
double least_sample_distance(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                             double spacing);

/// Spacing for poisson_samples() at which texels are hit: in a maximal set every disc whose radius
/// is the spacing holds a sample, so the spacing is the radius of the disc inscribed in a texel on
/// the surface (half a texel where texels are square). Texels differ in size: the radius taken is
/// the one that 98% of the claimed texels reach, but not less than gives 16 samples per texel on
/// average, so that a few tiny texels don't make millions of samples. Where the second bound does
/// not bite, at least 98% of the texels that lie wholly inside a chart get a sample; on uniform
/// charts all of them do, with about 2.8 samples per texel.
/// \throw InputError if no texel lies on the surface
double default_poisson_spacing(const TriangleMesh& mesh, const TexelMap& map);

}  // namespace onmesh
