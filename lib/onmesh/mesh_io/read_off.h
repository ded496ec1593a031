// OFF, with the prefixes ST (texture coordinates), C (colours) and N (normals).
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Read a text OFF file.
/// \param path of the file, for messages
/// \param content the whole of it
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_off(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
