// Meshes cut into charts, and textures painted on them.
#pragma once

#include <functional>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Give every group of faces UVs of its own.
/// \param group of a face
/// \param place of a UV of the mesh in a group
TriangleMesh cut(const TriangleMesh& mesh, const std::function<int(Index)>& group,
                 const std::function<Vec2(int, const Vec2&)>& place);

/// The surface of [0,1]^3, n x n cells a side, each side a chart turned by its own angle.
TriangleMesh turned_cube(Index n);

/// [0,1]^2 in n x n cells cut at x = 1/2, its halves turned, scaled and apart.
TriangleMesh halves(int n);

/// Two unit squares that share an edge in space, a chart each.
/// \param ratio how many times as large the second one's texels are
/// \param stretch how many times as long as wide they are
TriangleMesh two_squares(double ratio, double stretch = 1);

/// A plane whose chart is turned, so that texels along its border are covered in part.
TriangleMesh turned_plane(double degrees);

/// Covered texels get function(surface position), all others `rest`.
Image paint(const TriangleMesh& mesh, const TexelMap& map,
            const std::function<double(const Vec3&)>& function, float rest);

}  // namespace onmesh
