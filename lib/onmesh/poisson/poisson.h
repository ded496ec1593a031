// Poisson-disk samples of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

class TexelMap;

/// What to sample, and how.
struct PoissonOptions {
  double spacing = 0;       ///< minimum distance of two samples, mesh units, > 0
  std::uint64_t seed = 1;   ///< another seed, other samples
  std::vector<bool> faces;  ///< faces to sample; empty = all with area
};

/// A maximal set of random samples with a minimum spacing.
///
/// Random points (CGAL) are thrown like darts (Cook, "Stochastic sampling in computer graphics",
/// 1986) and kept unless they conflict, then the gaps between them are filled (as Gamito and
/// Maddock, "Accurate multidimensional Poisson-disk sampling", 2009, and Ebeida et al., "A simple
/// algorithm for maximal Poisson-disk sampling in high dimensions", 2012, do in boxes) until the
/// set is maximal.
///
/// Two samples conflict when they are closer than the spacing in space *and* joined by surface
/// within the ball of that radius around one of them; so the two sides of a thin sheet don't thin
/// each other out. All faces count as surface there, sampled or not. The set is maximal: every
/// point of the sampled surface has a sample it conflicts with, up to 1e-3 of the spacing. Same
/// options, same samples, on any machine and thread count. On a plane there are about 0.7 /
/// spacing^2 samples per unit of area.
/// \param progress told of "samples"
/// \pre mesh is welded
/// \throw UsageError if the spacing is not a positive number
/// \throw InputError if no face to sample has area, or if the spacing would need more than 2^28
///   samples
std::vector<SurfacePoint> poisson_samples(const TriangleMesh& mesh, const PoissonOptions& options,
                                          const Progress& progress = {});

/// Samples that each have a spacing of their own.
struct GradedSamples {
  std::vector<SurfacePoint> points;  ///< the samples
  std::vector<double> spacings;      ///< of each, mesh units
};

/// Samples that hit every texel claimed on the faces to sample: each has one in its square on its
/// own chart, also where the chart covers only a part of the square.
///
/// The spacing follows the size of the texels (SpacingField), and two samples conflict when they
/// are closer than the smaller of their spacings and joined by surface within the ball of its own
/// spacing around one of them. The set is maximal as above, which leaves few texels out: those get
/// a sample in the end, whose spacing is the distance to the next one. On square texels that is
/// about 2.8 samples per texel, on others more by the ratio of their sides, up to 16; `spacing` of
/// the options is not used.
/// \param map of the mesh
/// \param progress told of "samples"
/// \pre mesh is welded
/// \throw InputError if no texel lies on the surface, no face to sample has area, or more than
///   2^28 samples would be needed
GradedSamples texel_poisson_samples(const TriangleMesh& mesh, const TexelMap& map,
                                    const PoissonOptions& options, const Progress& progress = {});

/// Smallest distance of two samples in space, mesh units, leaving out pairs closer than the smaller
/// of their spacings that don't conflict because the surface does not join them; infinite if no two
/// are within twice the least spacing.
double least_sample_distance(const TriangleMesh& mesh, const GradedSamples& samples);
/// The same for samples that share one spacing.
double least_sample_distance(const TriangleMesh& mesh, const std::vector<SurfacePoint>& samples,
                             double spacing);

}  // namespace onmesh
