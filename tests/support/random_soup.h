// Triangles between random points: thin faces, edges with many faces, intersections.
#pragma once

#include <algorithm>
#include <random>

#include "support/small_meshes.h"

namespace onmesh {

/// So many different faces between twelve points of a box of 1 x 1 x depth.
inline TriangleMesh random_soup(std::size_t face_count, double depth, std::mt19937& random) {
  const auto uniform = [&] { return double(random()) / 4294967296.0; };
  std::vector<Vec3> positions;
  for (int i = 0; i < 12; ++i) positions.emplace_back(uniform(), uniform(), depth * uniform());
  std::vector<std::array<Index, 3>> faces;
  while (faces.size() < face_count) {
    std::array<Index, 3> f{Index(random() % 12), Index(random() % 12), Index(random() % 12)};
    std::sort(f.begin(), f.end());
    if (f[0] == f[1] || f[1] == f[2]) continue;
    if (std::find(faces.begin(), faces.end(), f) == faces.end()) faces.push_back(f);
  }
  return bare_mesh(std::move(positions), std::move(faces));
}

}  // namespace onmesh
