// Reading meshes: OBJ with MTL, PLY, OFF, STL and glTF, validated.
#pragma once

#include <filesystem>
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// Read a mesh; the format follows the file's content, and its extension where the content leaves
/// that open. Polygons are triangulated (a fan where that gives no sliver, else by ear clipping in
/// the polygon's plane; corners keep their UVs). The result is as in the file: see weld() for
/// meshes that arrive split at seams. UVs that are not finite count as missing, with a warning.
/// \param report if given, receives what was read, ignored, assumed or repaired
/// \throw FileError if the file cannot be opened or read
/// \throw InputError naming file, line (or element) and what is wrong: bad number, coordinate
///   that is not finite, index out of range, truncated data, no faces
TriangleMesh read_mesh(const std::filesystem::path& path, ReadReport* report = nullptr,
                       const ReadOptions& options = {});

}  // namespace onmesh
