// How visible a texture's seams are.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// How much the two sides of all seams differ.
struct SeamError {
  double rms = 0;     ///< root mean square of the values' differences
  double max = 0;     ///< the largest of them
  double length = 0;  ///< surface length of all seams, mesh units
  Index edges = 0;    ///< seam edges
};

/// Compare bilinear look-ups on both sides of every seam edge (an edge whose two faces carry the
/// texture with different UVs there), at about two points per texel along it.
///
/// RMS is over the seams' length and all channels. Where more than two faces meet, each is compared
/// with the one that goes on most straight.
/// Seams between tiles count like those within one.
/// \param images one per tile of the map, with the same channels
/// \param tile only seams with a side in this one; kNone = all
/// \pre mesh and map belong together
/// \throw InputError if the map is not of the images' sizes
SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map,
                     const std::vector<const Image*>& images, Index tile = kNone);

/// The same for a map of one tile.
SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map, const Image& image);

}  // namespace onmesh
