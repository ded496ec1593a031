// The filter by its definition: brute force in double, texels found by a rasteriser of its own,
// distances from outside. No step is shared with the library, so what the two agree on is right.
#pragma once

#include <cstddef>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "support/distances.h"

namespace onmesh {

/// The samples of texel quadrature: one per texel and chart, ordered by face, row and column.
///
/// A texel's place on a chart is its centre, if that lies in or on a UV face of the chart. A centre
/// on an edge or a corner that several faces of the chart share belongs to the lowest face. A chart
/// without any centre gets the texel that it overlaps most. Where charts have less than half of a
/// texel in common, and no two by two texels next to it, the one that covers most of it has it
/// alone.
struct TexelPoints {
  std::vector<SurfacePoint> points;
  std::vector<Vec3> positions;
  std::vector<Index> texels;  ///< row * width + column
  std::vector<double> areas;  ///< surface area of the whole texel, mesh units squared
  std::vector<Index> charts;  ///< the chart's lowest face
};

/// \param repeat UVs outside [0,1] repeat the image; else texels outside it are left out
/// \pre the mesh is welded
TexelPoints texel_points(const TriangleMesh& mesh, int width, int height, bool repeat = true);

/// The length `1tx`: the median of the square roots of the texels' surface areas, mesh units.
double median_texel_size(const TexelPoints& all);

/// A sample with all others that may lie within a radius, and its distances to them.
struct Neighbourhood {
  std::size_t centre = 0;
  std::vector<std::size_t> near;
  std::vector<double> distances;
};

Neighbourhood neighbourhood(const TexelPoints& all, std::size_t centre, double radius,
                            const Distances& distances);

struct Weights {
  double sigma = 0, radius = 0;  ///< mesh units
  double sigma_range = 0;        ///< value units; 0: no colour weight, that is the Gaussian filter
  /// Per texel, how much it counts as a sample; texels of 0 have no value. Empty: all 1.
  std::vector<float> of_samples = {};
  /// Features of guides, each divided by its width: so many for each texel, side by side.
  std::vector<float> features = {};
  std::size_t features_each = 0;
  /// So many of the last are of own values: targets without a value are not compared by them.
  std::size_t own_features = 0;
};

/// The filter's value at the neighbourhood's centre, one number per channel. Alpha stays; it is the
/// samples' weight, and what has none keeps its values. A texel with a value that is not finite is
/// no sample, and has the mean without the colour weight.
/// \param pairs the samples that took part are added to it
std::vector<double> filtered_value(const TexelPoints& all, const Neighbourhood& around,
                                   const Image& texture, const Weights& weights,
                                   std::size_t* pairs = nullptr);

struct DefinitionError {
  double psnr = 0;         ///< dB, peak 1, over the values compared
  double worst = 0;        ///< largest difference of a value
  std::size_t pairs = 0;   ///< (target, sample) pairs summed
  std::size_t shared = 0;  ///< texels compared that several places of the surface claim
};

/// How far `result` is from the filter's definition, on `count` texels chosen at random with a
/// fixed seed. Texels of several places have the mean of their values there, weighted by area.
/// Alpha and colours without alpha must be the texture's: else, and if the result is not finite,
/// `worst` is infinite. \pre the mesh is welded and clean
DefinitionError against_definition(const TriangleMesh& mesh, const Image& texture,
                                   const Image& result, const Weights& weights, std::size_t count,
                                   const Distances& distances);

}  // namespace onmesh
