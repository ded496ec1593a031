// Polygons as files hold them, on their way to a TriangleMesh.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh {

/// What a reader collects: positions, UVs and materials in `mesh`, faces as polygons beside it.
struct PolygonMesh {
  TriangleMesh mesh;                     ///< without faces
  std::vector<Index> corners;            ///< into mesh.positions, all polygons one after the other
  std::vector<Index> corner_uvs;         ///< into mesh.uvs, one per corner; kNone = none
  std::vector<Index> corner_normals;     ///< into mesh.normals likewise; empty if no corner has any
  std::vector<std::size_t> polygon_end;  ///< one past each polygon's last corner
  std::vector<Index> polygon_materials;  ///< one per polygon

  void add_corner(Index position, Index uv, Index normal = kNone) {
    corners.push_back(position);
    corner_uvs.push_back(uv);
    if (normal == kNone && corner_normals.empty()) return;
    if (corner_normals.empty()) {
      corner_normals.reserve(corners.capacity());
      corner_normals.resize(corners.size() - 1, kNone);
    }
    corner_normals.push_back(normal);
  }
  void end_polygon(Index material) {
    polygon_end.push_back(corners.size());
    polygon_materials.push_back(material);
  }
};

/// UVs that are not finite count as missing: corners have none then, and the UVs become zero. One
/// bad UV must not cost the whole mesh.
/// \param report receives a warning that names `file` and how many there were
void drop_missing_uvs(PolygonMesh& polygons, const std::string& file, ReadReport& report);

/// What drop_missing_uvs() tells, for those that drop them otherwise.
std::string missing_uvs_text(const std::string& file, std::size_t missing);

/// The same for normals.
void drop_missing_normals(PolygonMesh& polygons, const std::string& file, ReadReport& report);

/// Triangles in the order of the polygons; corners keep their UVs and normals.
/// \pre every polygon has at least three corners, all within the positions, UVs and normals
/// \throw InputError naming `file` if there are no faces or more elements than an Index can count
TriangleMesh triangulate(PolygonMesh polygons, const std::string& file);

}  // namespace onmesh
