// Values for covered texels that have none.
#pragma once

#include <cstdint>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// Fill covered texels with a value that is not finite, ring by ring: each gets the mean of those
/// of its 8 neighbours in the image that have values and are covered by the same chart, once there
/// are any. Alpha stays, and so do texels where it is 0.
/// \return how many have no value even so: no texel of their chart has any
std::uint64_t fill_rings(const TexelMap& map, const TexelValues& values);

}  // namespace onmesh
