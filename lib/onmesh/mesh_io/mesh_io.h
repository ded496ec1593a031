// Reading meshes: OBJ + MTL, PLY, OFF and STL, validated. Writing OBJ. (PLY: ply.h)
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Read a mesh; the format follows the file's content, and its extension where the content leaves
/// that open. Polygons are triangulated (a fan where that gives no sliver, else by ear clipping in
/// the polygon's plane; corners keep their UVs). The result is as in the file: see weld() for
/// meshes that arrive split at seams. UVs that are not finite count as missing, with a warning.
/// \param warnings if given, receives one line per thing that was ignored or repaired
/// \throw FileError if the file cannot be opened or read
/// \throw InputError naming file, line (or element) and what is wrong: bad number, coordinate
///   that is not finite, index out of range, truncated data, no faces
TriangleMesh read_mesh(const std::filesystem::path& path,
                       std::vector<std::string>* warnings = nullptr);

/// Write an OBJ with UVs and materials, and its MTL beside it when the mesh has materials.
/// Coordinates are written so that they read back bit for bit. Atomic (temporary file, then
/// rename). \throw FileError
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh);

// One reader per format, each given the file's whole content.
TriangleMesh read_obj(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);
TriangleMesh read_ply(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);
TriangleMesh read_off(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);
TriangleMesh read_stl(const std::filesystem::path& path, const std::string& content,
                      std::vector<std::string>* warnings);

/// Split the polygon with these corner positions into triangles of corner numbers.
std::vector<std::array<Index, 3>> triangulate_polygon(const std::vector<Vec3>& corners);

}  // namespace onmesh
