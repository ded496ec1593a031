#include "onmesh/procedural/grid_builder.h"

#include <cmath>
#include <string>

#include "onmesh/base/error.h"

namespace onmesh {

void GridBuilder::add_chart(int nx, int ny, const std::function<Point(int, int)>& point) {
  const auto columns = Index(nx) + 1;
  const auto first_uv = Index(mesh_.uvs.size());
  std::vector<Index> vertices;
  vertices.reserve(std::size_t(columns) * (std::size_t(ny) + 1));
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const Point p = point(i, j);
      const auto [entry, is_new] = vertex_of_.try_emplace(p.key, Index(mesh_.positions.size()));
      if (is_new) mesh_.positions.push_back(p.position);
      vertices.push_back(entry->second);
      mesh_.uvs.push_back(p.uv);
    }
  }
  for (Index j = 0; j < Index(ny); ++j) {
    for (Index i = 0; i < Index(nx); ++i) {
      const Index a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
      add_face(vertices, first_uv, {a, b, c});
      add_face(vertices, first_uv, {a, c, d});
    }
  }
}

void GridBuilder::add_face(const std::vector<Index>& vertices, Index first_uv,
                           const std::array<Index, 3>& grid) {
  const std::array<Index, 3> corners{vertices[grid[0]], vertices[grid[1]], vertices[grid[2]]};
  // A row of the grid may shrink to a point (the tip of a cone).
  if (has_repeated_vertex(corners)) return;
  mesh_.faces.push_back(corners);
  mesh_.face_uvs.push_back({first_uv + grid[0], first_uv + grid[1], first_uv + grid[2]});
  mesh_.face_materials.push_back(kNone);
}

void require(bool condition, const char* message) {
  if (!condition) throw UsageError(message);
}

void require_segments(const char* shape, std::initializer_list<int> counts, int least) {
  for (const int n : counts) {
    if (n < least || n > 8192)
      throw UsageError(std::string(shape) + ": segments must be between " + std::to_string(least) +
                       " and 8192");
  }
}

bool positive(double x) { return x > 0 && std::isfinite(x); }

}  // namespace onmesh
