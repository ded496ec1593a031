// What tests of the texel map share.
#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "support/atlas_meshes.h"

namespace onmesh {

/// [0,1]^2 in two triangles over the whole image.
inline TriangleMesh square() {
  return flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
}

/// The unit square in random triangles; if `lattice` > 0 all points are snapped to half cells of a
/// lattice x lattice image, so that many of them hit texel centres and corners.
inline TriangleMesh random_square(unsigned seed, int splits, int lattice) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<std::array<Index, 3>> faces = {{0, 1, 2}, {0, 2, 3}};
  const auto area = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  for (int i = 0; i < splits; ++i) {
    const std::size_t f = random() % faces.size();
    const auto t = faces[f];
    double r = unit(random), s = unit(random);
    if (r + s > 1) r = 1 - r, s = 1 - s;
    Vec2 p = uvs[t[0]] + r * (uvs[t[1]] - uvs[t[0]]) + s * (uvs[t[2]] - uvs[t[0]]);
    if (lattice > 0) p = (p * 2 * lattice).array().round().matrix() / (2.0 * lattice);
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && area(uvs[t[k]], uvs[t[(k + 1) % 3]], p) > 1e-12;
    if (!inside) continue;
    const auto n = Index(uvs.size());
    uvs.push_back(p);
    faces[f] = {t[0], t[1], n};
    faces.push_back({t[1], t[2], n});
    faces.push_back({t[2], t[0], n});
  }
  std::shuffle(faces.begin(), faces.end(), random);
  return flat(uvs, faces);
}

/// How often each texel is claimed.
inline std::vector<int> claim_counts(const TexelMap& map) {
  std::vector<int> counts(map.coverage.size(), 0);
  for (const auto& claim : map.claims) ++counts[map.tiles[0].texel(claim)];
  return counts;
}

/// Corners of a face's UV triangle in pixels.
inline std::vector<Vec2> pixel_corners(const TriangleMesh& mesh, Index face, int width,
                                       int height) {
  std::vector<Vec2> corners;
  for (const Vec2& uv : mesh.corner_uvs(face))
    corners.emplace_back(uv.x() * width, (1 - uv.y()) * height);
  return corners;
}

/// Surface area of the claimed texels.
inline double claimed_area(const TexelMap& map) {
  double sum = 0;
  for (std::size_t f = 0; f < map.texel_area.size(); ++f)
    sum += map.texel_area[f] * (map.face_offsets[f + 1] - map.face_offsets[f]);
  return sum;
}

/// How many charts make_texel_map() finds, over all textures.
inline Index charts_on_map(const TriangleMesh& mesh) {
  std::map<std::string, std::vector<bool>> faces_with;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index material = mesh.face_materials[f];
    const std::string texture = material == kNone ? "" : mesh.materials[material].texture;
    const auto faces = faces_with.try_emplace(texture, mesh.faces.size(), false).first;
    faces->second[f] = true;
  }
  Index charts = 0;
  for (const auto& [texture, faces] : faces_with)
    charts += make_texel_map(mesh, 512, 512, {Wrap::repeat, faces}).charts;
  return charts;
}

}  // namespace onmesh
