// STL, text and binary.
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Whether the content has the size of a binary STL with as many facets as it says, and any.
bool is_binary_stl(const std::string& content);

/// Read an STL file, text or binary. Its triangles share no vertices: weld() joins them.
/// \param path of the file, for messages
/// \param content the whole of it
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_stl(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
