// Basic types shared by every stage.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace onmesh {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Index of a vertex, face, node or texel.
using Index = std::uint32_t;

/// "No such element".
inline constexpr Index kNone = 0xffffffffU;

}  // namespace onmesh
