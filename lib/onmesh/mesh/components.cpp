#include "onmesh/mesh/components.h"

#include <utility>

#include "onmesh/base/disjoint_sets.h"

namespace onmesh {

FaceComponents connected_components(const TriangleMesh& mesh) {
  DisjointSets vertices(mesh.positions.size());
  for (const auto& face : mesh.faces) {
    vertices.join(face[0], face[1]);
    vertices.join(face[0], face[2]);
  }
  std::vector<Index> roots;
  roots.reserve(mesh.faces.size());
  for (const auto& face : mesh.faces) roots.push_back(vertices.find(face[0]));
  NumberedSets components = number_sets(std::move(roots));
  return {std::move(components.numbers), components.count};
}

}  // namespace onmesh
