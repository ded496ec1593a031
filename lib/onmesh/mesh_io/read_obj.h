// Wavefront OBJ with its material files.
#pragma once

#include <filesystem>
#include <string>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Read an OBJ and its material files: see find_obj_materials(). UVs are those that the textures'
/// options make of them.
/// \param path of the file, for messages and to find the files that it names
/// \param content the whole of it
/// \param report receives what was read, ignored, assumed or repaired
/// \throw InputError naming the file and what is wrong with it
TriangleMesh read_obj(const std::filesystem::path& path, const std::string& content,
                      const ReadOptions& options, ReadReport& report);

}  // namespace onmesh
