// OFF, with the prefixes ST (texture coordinates), C (colours) and N (normals).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Read a text OFF file.
/// \param path of the file, for messages
/// \param content the whole of it
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_off(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);

}  // namespace onmesh
