// PLY: text and both binary byte orders.
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Read a PLY file, text or binary. UVs come per vertex (s t, u v or texture_u texture_v) or per
/// corner (texcoord); comments "TextureFile NAME" name textures, texnumber chooses one per face.
/// \param path of the file, for messages and to find the files that it names
/// \param content the whole of it
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
