// Extending filtered charts into the texels around them.
#pragma once

#include <vector>

#include "onmesh/image.h"
#include "onmesh/texel_map.h"

namespace onmesh {

/// Fill every touched texel, and `rings` rings of 8-neighbours around charts, from the filtered
/// surface: the value at the closest point of the nearest chart, looked up bilinearly among that
/// chart's covered texels only. Covered texels are not changed, nor any other. Rings wrap around the
/// image with Wrap::repeat.
/// \return the texels that were filled, ascending
std::vector<Index> fill_gutter(const TriangleMesh& mesh, const TexelMap& map, int rings, Image& image);

}  // namespace onmesh
