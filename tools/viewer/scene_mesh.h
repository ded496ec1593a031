// The model of a review page: vertices as a graphics card takes them.
#pragma once

#include <nlohmann/json.hpp>

#include "review.h"

namespace onmesh::tools {

/// The faces of the file with their UVs, each in its own tile.
TriangleMesh mesh_with_local_uvs(const Review& review, const TriangleMesh& mesh,
                                 const std::vector<Index>& tile_of_face);

/// Corners with the same position, UV and normal become one vertex. Positions of large meshes are
/// rounded to 16 bits.
/// \param mesh its faces are the file's, with UVs of their own tiles
/// \param notes receive what the page leaves out
/// \throw InputError if nothing can be shown
nlohmann::json scene_mesh(const Review& review, const TriangleMesh& mesh, PageWriter& page,
                          std::vector<std::string>& notes);

/// Unit vectors as bytes.
std::vector<std::int8_t> rounded_normals(const std::vector<Vec3>& normals);

}  // namespace onmesh::tools
