// Geodesic distances as the oracle takes them, whatever they come from.
#pragma once

#include <functional>
#include <vector>

#include "onmesh/mesh/surface_point.h"

namespace onmesh {

/// Geodesic distances (mesh units) from one point of the surface to many; NaN or infinity where
/// there is none.
using Distances = std::function<std::vector<double>(const SurfacePoint& source,
                                                    const std::vector<SurfacePoint>& targets)>;

}  // namespace onmesh
