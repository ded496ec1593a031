#include "onmesh/mesh/vertex_fans.h"

namespace onmesh {

DisjointSets join_fans(const TriangleMesh& mesh, const EdgeTable& edges) {
  DisjointSets corners(3 * mesh.faces.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    for (const Index v : edges.vertices(e)) {
      for (std::size_t i = 1; i < sides.size(); ++i) {
        corners.join(corner_at(mesh, sides[0], v), corner_at(mesh, sides[i], v));
      }
    }
  }
  return corners;
}

std::vector<Index> count_fans(const TriangleMesh& mesh, DisjointSets& fans) {
  std::vector<Index> count(mesh.positions.size(), 0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (has_repeated_vertex(mesh.faces[f])) continue;
    for (Index k = 0; k < 3; ++k) {
      if (fans.find(3 * f + k) == 3 * f + k) ++count[mesh.faces[f][k]];
    }
  }
  return count;
}

}  // namespace onmesh
