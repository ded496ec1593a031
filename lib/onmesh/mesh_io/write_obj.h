// Writing meshes as OBJ with MTL.
#pragma once

#include <filesystem>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Write an OBJ with UVs, normals and materials, and its MTL beside it when the mesh has materials.
///
/// Coordinates are written so that they read back bit for bit. Both files are written atomically
/// (temporary file, then rename). Nameless and equally named materials get a number; textures are
/// named relative to the file's folder. Of wrap modes only clamping both ways is written.
/// \throw FileError if a file cannot be written
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace onmesh
