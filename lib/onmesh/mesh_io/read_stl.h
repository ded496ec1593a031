// STL, text and binary.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Read an STL file, text or binary. Its triangles share no vertices: weld() joins them.
/// \param path of the file, for messages
/// \param content the whole of it
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_stl(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);

}  // namespace onmesh
