// Whether a texture's seams show beside a reference.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Root mean squares of (a_1 - a_2) - (b_1 - b_2) over pairs of points one texel apart, over all
/// channels: what is wrong between two neighbours.
struct SeamResidual {
  double seams = 0;          ///< of pairs on both sides of a seam where the surface is smooth
  double folds = 0;          ///< of those where it folds by more than 30 degrees
  double inside = 0;         ///< of pairs on both sides of other edges
  std::size_t at_seams = 0;  ///< values compared
  std::size_t at_folds = 0;  ///< the same
  std::size_t within = 0;    ///< the same
};

/// Compare steps from side to side in two textures: a seam that nobody sees is no worse than other
/// edges, where nothing is cut. Where the reference has a step at a seam, so may the
/// other. At folds light changes from side to side, and both sides err independently: there it is
/// told apart.
///
/// On both sides of an edge, at two points per texel along it, values are looked up half a texel
/// inside, among the texels of that face that count.
/// \param a, b one image per tile of the map, with the same channels
/// \param counted per texel of all tiles; empty = all
/// \pre mesh and map belong together
/// \throw InputError if the map is not of the images' sizes
SeamResidual seam_residual(const TriangleMesh& mesh, const TexelMap& map,
                           const std::vector<const Image*>& a, const std::vector<const Image*>& b,
                           const std::vector<bool>& counted = {});

}  // namespace onmesh
