// Polygons in space cut into triangles.
#pragma once

#include <array>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// Split a polygon into triangles of corner numbers: a fan from its first corner where that gives
/// no sliver, else by ear clipping (Meisters 1975) in the plane of its normal. Polygons may be
/// concave, run along bridges to holes, or cross themselves (what is left then is fanned).
/// \param corners positions, in order
/// \return n - 2 triangles with the polygon's winding; none for less than three corners
std::vector<std::array<Index, 3>> triangulate_polygon(const std::vector<Vec3>& corners);

}  // namespace onmesh
