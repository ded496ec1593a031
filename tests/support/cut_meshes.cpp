#include "support/cut_meshes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include "onmesh/procedural/shapes.h"

namespace onmesh {

TriangleMesh cut(const TriangleMesh& mesh, const std::function<int(Index)>& group,
                 const std::function<Vec2(int, const Vec2&)>& place) {
  TriangleMesh result = mesh;
  result.uvs.clear();
  std::map<std::pair<int, Index>, Index> known;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const int g = group(f);
      const auto [it, fresh] =
          known.try_emplace({g, mesh.face_uvs[f][k]}, Index(result.uvs.size()));
      if (fresh) result.uvs.push_back(place(g, mesh.uvs[mesh.face_uvs[f][k]]));
      result.face_uvs[f][k] = it->second;
    }
  return result;
}

TriangleMesh turned_cube(Index n) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> known;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    const auto corner = [&](Index i, Index j) {
      std::array<int, 3> p{};
      p[std::size_t(axis)] = side % 2 ? int(n) : 0;
      p[std::size_t(u_axis)] = int(side % 2 ? i : n - i);
      p[std::size_t(v_axis)] = int(j);
      const auto [it, fresh] = known.try_emplace(p, Index(mesh.positions.size()));
      if (fresh) mesh.positions.push_back(Vec3(p[0], p[1], p[2]) / double(n));
      return it->second;
    };
    const auto first = Index(mesh.uvs.size());
    const double angle = 0.4 * side;
    for (Index j = 0; j <= n; ++j)
      for (Index i = 0; i <= n; ++i) {
        const Vec2 d(0.2 * (i / double(n) - 0.5), 0.2 * (j / double(n) - 0.5));
        mesh.uvs.emplace_back(
            0.17 + 0.33 * (side % 3) + std::cos(angle) * d.x() - std::sin(angle) * d.y(),
            0.25 + 0.5 * (side / 3) + std::sin(angle) * d.x() + std::cos(angle) * d.y());
        if (i == n || j == n) continue;
        const Index at = first + j * (n + 1) + i;
        mesh.faces.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
        mesh.face_uvs.push_back({at, at + 1, at + n + 2});
        mesh.faces.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        mesh.face_uvs.push_back({at, at + n + 2, at + n + 1});
      }
  }
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

Image paint(const TriangleMesh& mesh, const TexelMap& map,
            const std::function<double(const Vec3&)>& function, float rest) {
  Image image = make_image(map.tiles[0].width, map.tiles[0].height, 1);
  image.pixels.assign(image.pixels.size(), rest);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (Index i = map.face_offsets[f]; i < map.face_offsets[f + 1]; ++i) {
      const Vec3 b = map.barycentric(f, map.claims[i]);
      const auto p = mesh.corners(f);
      *image.texel(map.tiles[0].texel(map.claims[i])) =
          float(function(b[0] * p[0] + b[1] * p[1] + b[2] * p[2]));
    }
  return image;
}

TriangleMesh halves(int n) {
  const TriangleMesh mesh = make_plane(n, n);
  const auto side = [&](Index f) { return int(int(f) / 2 % n >= n / 2); };
  return cut(mesh, side, [](int g, const Vec2& uv) {
    const double angle = g ? 0.5 : -0.2, scale = g ? 0.4 : 0.46;
    const Vec2 d = scale * (uv - Vec2(g ? 0.75 : 0.25, 0.5));
    return Vec2((g ? 0.7 : 0.3) + std::cos(angle) * d.x() - std::sin(angle) * d.y(),
                0.5 + std::sin(angle) * d.x() + std::cos(angle) * d.y());
  });
}

TriangleMesh two_squares(double ratio, double stretch) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  const double w = 0.5 / ratio, h = 0.5 / ratio / stretch;
  mesh.uvs = {{0.02, 0.03},  {0.52, 0.03},      {0.52, 0.53},          {0.02, 0.53},
              {0.021, 0.56}, {0.021 + w, 0.56}, {0.021 + w, 0.56 + h}, {0.021, 0.56 + h}};
  mesh.face_uvs = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  mesh.face_materials.assign(4, kNone);
  return mesh;
}

TriangleMesh turned_plane(double degrees) {
  TriangleMesh mesh = make_plane(3, 3);
  const Eigen::Rotation2Dd turn(degrees * std::acos(-1.0) / 180);
  for (Vec2& uv : mesh.uvs) uv = Vec2(0.5, 0.5) + turn * (0.6 * (uv - Vec2(0.5, 0.5)));
  return mesh;
}

}  // namespace onmesh
