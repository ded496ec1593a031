// UVs as the materials of the faces want them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// An affine map of UVs: u' and v' are its rows times (u, v, 1).
using UvTransform = Eigen::Matrix<double, 2, 3>;

/// The map u' = s u + o, each direction by itself.
UvTransform scale_and_offset(const Vec2& scale, const Vec2& offset);

/// Rewrite the UVs that the faces of each material use by the material's map.
///
/// Where faces of several materials use one UV it is split if their maps or wrap modes differ, so
/// that faces of different modes have no UV index in common. All others keep theirs, and so do
/// the UVs that no face uses. Where neither maps nor modes differ from those of faces without a
/// material, nothing is changed.
///
/// UVs that are not finite afterwards count as missing: corners have none then.
/// \param transforms per material; those behind its end, and faces without a material, are mapped
///   to themselves
/// \pre the UVs are finite
/// \return how many UVs are missing now
Index transform_uvs(TriangleMesh& mesh, const std::vector<UvTransform>& transforms);

}  // namespace onmesh
