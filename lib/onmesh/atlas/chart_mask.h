// Values of texels from images of any size that are laid over the same charts.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Look up what a mask says of every covered texel: the first channel that is not alpha, looked up
/// bilinearly at the texel's centre among those texels of the mask that the same chart covers; if
/// there are none, among all. Values are taken into [0,1], what is no number is 0.
/// \param masks per tile of the map, of any size; null = 1 everywhere. They hide the whole tile.
/// \pre mesh and map belong together; every mask has a channel that is not alpha
/// \return one value per texel of all tiles, 1 where none is covered; nothing if there is no mask
std::vector<float> chart_mask(const TriangleMesh& mesh, const TexelMap& map,
                              const std::vector<const Image*>& masks);

}  // namespace onmesh
