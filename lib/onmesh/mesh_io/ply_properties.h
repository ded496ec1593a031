// What the properties of a PLY file's vertices and faces mean, by the names that programs give
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "onmesh/mesh_io/ply_header.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// What a value of a vertex is; all before `unwanted` are used.
enum class VertexValue : std::uint8_t { x, y, z, u, v, texture, unwanted };

/// What is read of vertices.
struct VertexProperties {
  std::vector<VertexValue> values;  ///< one per property
  std::string uv_names;             ///< "s t"; empty if vertices have no UVs
  bool has_texture = false;         ///< a number of a texture, texnumber
};

/// What a property of a face or triangle strip is.
enum class FaceValue : std::uint8_t {
  corners,   ///< list of vertex indices
  uvs,       ///< list of texture coordinates, for all corners
  texture,   ///< texnumber
  textures,  ///< list of a texnumber per corner
  unwanted,
};

/// What is read of faces or triangle strips.
struct FaceProperties {
  std::vector<FaceValue> values;  ///< one per property
  std::string uv_name;            ///< "texcoord"; empty if faces have no UVs
  bool has_corners = false;
  bool has_texture = false;  ///< one per face or per corner
};

/// Choose by name; a name may be in capitals if there is none that is not. Of several pairs of
/// texture coordinates the file's first one is taken.
/// \param report receives the names of what is not used
VertexProperties vertex_properties(const PlyElement& element, ReadReport& report);

/// The same for faces, or for triangle strips, whose UVs are those of their vertices.
FaceProperties face_properties(const PlyElement& element, bool strips, ReadReport& report);

}  // namespace onmesh
