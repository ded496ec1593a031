// Which chart covers which texel.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"

namespace onmesh {

/// \return per texel of all tiles the chart that covers it, the first one in the order of faces;
///   kNone = none does
std::vector<Index> charts_of_texels(const TexelMap& map);

}  // namespace onmesh
