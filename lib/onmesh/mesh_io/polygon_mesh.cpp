#include "onmesh/mesh_io/polygon_mesh.h"

#include <algorithm>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/mesh_io/polygon_triangulation.h"

namespace onmesh {
namespace {

/// Corners lose values that are not finite, which become zero.
/// \return how many there were
template <class Value>
std::size_t drop_missing(std::vector<Value>& values, std::vector<Index>& corners) {
  const auto missing = std::count_if(values.begin(), values.end(),
                                     [](const Value& value) { return !value.allFinite(); });
  if (missing == 0) return 0;
  for (Index& i : corners) {
    if (i != kNone && !values[i].allFinite()) i = kNone;
  }
  for (Value& value : values) {
    if (!value.allFinite()) value.setZero();
  }
  return static_cast<std::size_t>(missing);
}

}  // namespace

void drop_missing_uvs(PolygonMesh& polygons, const std::string& file, ReadReport& report) {
  const std::size_t missing = drop_missing(polygons.mesh.uvs, polygons.corner_uvs);
  if (missing > 0) report.warnings.push_back(missing_uvs_text(file, missing));
}

std::string missing_uvs_text(const std::string& file, std::size_t missing) {
  return file + ": " + std::to_string(missing) +
         " texture coordinates are not finite and count as missing";
}

void drop_missing_normals(PolygonMesh& polygons, const std::string& file, ReadReport& report) {
  const std::size_t missing = drop_missing(polygons.mesh.normals, polygons.corner_normals);
  if (missing == 0) return;
  report.warnings.push_back(file + ": " + std::to_string(missing) +
                            " normals are not finite and count as missing");
}

TriangleMesh triangulate(PolygonMesh polygons, const std::string& file) {
  TriangleMesh mesh = std::move(polygons.mesh);
  if (polygons.polygon_end.empty()) throw InputError(file + ": has no faces");
  const std::size_t faces = polygons.corners.size() - 2 * polygons.polygon_end.size();
  if (std::max({mesh.positions.size(), mesh.uvs.size(), mesh.normals.size(), faces}) >= kNone) {
    throw InputError(file + ": has more vertices or faces than 32 bits can count");
  }
  mesh.faces.reserve(faces);
  mesh.face_uvs.reserve(faces);
  mesh.face_materials.reserve(faces);
  const bool has_normals = !polygons.corner_normals.empty();
  if (has_normals) mesh.face_normals.reserve(faces);
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
      if (has_normals) mesh.face_normals.push_back(pick(polygons.corner_normals));
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
