// PLY: text and both binary byte orders.
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Read a PLY file, text or binary: polygons (element face) and triangle strips (tristrips). UVs
/// come per vertex (s t, u v, texture_u texture_v and the like) or per corner (texcoord); comments
/// "TextureFile NAME" name textures, where <this> stands for the file's own name without extension,
/// and texnumber chooses one per face or vertex.
/// \param path of the file, for messages and to find the files that it names
/// \param content the whole of it
/// \param options are those of all readers; files that a PLY names are not read here
/// \param report receives what was found, ignored and assumed
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
