// How the two sides of each seam edge differ (internal: seam_error() sums it up).
#pragma once

#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/measure/seams.h"

namespace onmesh {

/// A seam edge with the difference of its two sides, over its length and all channels.
struct MeasuredSeam : Seam {
  double length = 0;       ///< on the surface, mesh units
  double mean_square = 0;  ///< of the values' differences
  double max = 0;          ///< the largest of them
};

/// Every seam measured, as seam_error() describes.
/// \param images one per tile of the map, with the same channels
/// \pre mesh and map belong together
/// \throw InputError if the map is not of the images' sizes
std::vector<MeasuredSeam> measure_seams(const TriangleMesh& mesh, const TexelMap& map,
                                        const std::vector<const Image*>& images);

}  // namespace onmesh
