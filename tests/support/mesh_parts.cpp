#include "support/mesh_parts.h"

#include <random>

#include "onmesh/procedural/shapes.h"

namespace onmesh {

TriangleMesh textured_square(int n, const Vec2& scale, const Vec2& offset) {
  TriangleMesh mesh = make_plane(n, n);
  for (Vec2& uv : mesh.uvs) uv = uv.cwiseProduct(scale) + offset;
  return mesh;
}

TriangleMesh side_by_side(const TriangleMesh& first, const TriangleMesh& second, const Vec3& move) {
  TriangleMesh mesh = first;
  const auto vertices = static_cast<Index>(mesh.positions.size());
  const auto uvs = static_cast<Index>(mesh.uvs.size());
  for (const Vec3& p : second.positions) mesh.positions.push_back(p + move);
  mesh.uvs.insert(mesh.uvs.end(), second.uvs.begin(), second.uvs.end());
  for (auto face : second.faces) {
    for (Index& v : face) v += vertices;
    mesh.faces.push_back(face);
  }
  for (auto face : second.face_uvs) {
    for (Index& uv : face)
      if (uv != kNone) uv += uvs;
    mesh.face_uvs.push_back(face);
  }
  mesh.face_materials.insert(mesh.face_materials.end(), second.face_materials.begin(),
                             second.face_materials.end());
  return mesh;
}

std::vector<SurfacePoint> random_points(const TriangleMesh& mesh, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> areas;
  for (Index f = 0; f < mesh.faces.size(); ++f) areas.push_back(mesh.face_area(f));
  std::discrete_distribution<Index> face(areas.begin(), areas.end());
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back({face(random), {1 - u - v, u, v}});
  }
  return points;
}

}  // namespace onmesh
