#include "onmesh/mesh_io/polygon_mesh.h"

#include <algorithm>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/polygon_triangulation.h"

namespace onmesh {

void drop_missing_uvs(PolygonMesh& polygons, const std::string& file, ReadReport& report) {
  std::vector<Vec2>& uvs = polygons.mesh.uvs;
  const auto missing =
      std::count_if(uvs.begin(), uvs.end(), [](const Vec2& uv) { return !uv.allFinite(); });
  if (missing == 0) return;
  for (Index& uv : polygons.corner_uvs) {
    if (uv != kNone && !uvs[uv].allFinite()) uv = kNone;
  }
  for (Vec2& uv : uvs) {
    if (!uv.allFinite()) uv.setZero();
  }
  report.warnings.push_back(file + ": " + std::to_string(missing) +
                            " texture coordinates are not finite and count as missing");
}

TriangleMesh triangulate(PolygonMesh polygons, const std::string& file) {
  TriangleMesh mesh = std::move(polygons.mesh);
  if (polygons.polygon_end.empty()) throw InputError(file + ": has no faces");
  const std::size_t faces = polygons.corners.size() - 2 * polygons.polygon_end.size();
  if (std::max({mesh.positions.size(), mesh.uvs.size(), faces}) >= kNone) {
    throw InputError(file + ": has more vertices or faces than 32 bits can count");
  }
  mesh.faces.reserve(faces);
  mesh.face_uvs.reserve(faces);
  mesh.face_materials.reserve(faces);
  std::vector<Vec3> points;
  std::size_t begin = 0;
  for (std::size_t p = 0; p < polygons.polygon_end.size(); ++p) {
    const std::size_t end = polygons.polygon_end[p];
    const auto add = [&](const std::array<Index, 3>& t) {
      const auto pick = [&](const std::vector<Index>& from) {
        return std::array<Index, 3>{from[begin + t[0]], from[begin + t[1]], from[begin + t[2]]};
      };
      mesh.faces.push_back(pick(polygons.corners));
      mesh.face_uvs.push_back(pick(polygons.corner_uvs));
      mesh.face_materials.push_back(polygons.polygon_materials[p]);
    };
    if (end - begin == 3) {
      add({0, 1, 2});
    } else {
      points.clear();
      for (std::size_t i = begin; i < end; ++i)
        points.push_back(mesh.positions[polygons.corners[i]]);
      for (const auto& t : triangulate_polygon(points)) add(t);
    }
    begin = end;
  }
  return mesh;
}

}  // namespace onmesh
