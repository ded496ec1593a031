#include "support/rounded_meshes.h"

#include <cmath>
#include <limits>
#include <random>

#include "onmesh/mesh/edge_table.h"

namespace onmesh {

void round_to_floats(TriangleMesh& mesh, unsigned seed, const std::function<bool(Index)>& moved) {
  std::mt19937 random(seed);
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    for (double& x : mesh.positions[v]) {
      auto rounded = static_cast<float>(x);
      if (moved(v) && random() % 2 == 0)
        rounded = std::nextafter(rounded, std::numeric_limits<float>::max());
      x = static_cast<double>(rounded);
    }
  }
  mesh.precision.single = true;
}

TriangleMesh rounded_soup(const TriangleMesh& mesh, unsigned seed) {
  TriangleMesh soup = loosen(mesh);
  round_to_floats(soup, seed, [](Index) { return true; });
  return soup;
}

TriangleMesh rectangle(double x, double y, double width, double height, int columns, int rows) {
  TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Vec2 p(x + width * i / columns, y + height * j / rows);
      mesh.positions.emplace_back(p.x(), p.y(), 0);
      mesh.uvs.push_back(p);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<Index>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  mesh.face_uvs = mesh.faces;
  mesh.face_materials.assign(mesh.faces.size(), kNone);
  return mesh;
}

Index count_boundary(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  Index count = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) count += edges.sides(e).size() == 1;
  return count;
}

double shortest_edge(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges.vertices(e);
    shortest = std::min(shortest, (mesh.positions[a] - mesh.positions[b]).norm());
  }
  return shortest;
}

}  // namespace onmesh
