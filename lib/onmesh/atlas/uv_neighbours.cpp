#include "onmesh/atlas/uv_neighbours.h"

#include <utility>

namespace onmesh {

UvNeighbours::UvNeighbours(const TriangleMesh& mesh, const std::vector<bool>& used)
    : mesh_(mesh), offsets_(mesh.uvs.size() + 1, 0) {
  for (Index f = 0; f < mesh.faces.size(); ++f)
    if (used[f])
      for (const Index uv : mesh.face_uvs[f]) ++offsets_[uv + 1];
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  faces_.resize(offsets_.back());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    if (used[f])
      for (const Index uv : mesh.face_uvs[f]) faces_[next[uv]++] = f;
}

void UvNeighbours::add_edges(Index face, Index uv, std::vector<std::array<Index, 4>>& edges) const {
  const auto& p = mesh_.faces[face];
  const auto& u = mesh_.face_uvs[face];
  for (std::size_t k = 0; k < 3; ++k) {
    // The same order of ends for all faces of the edge.
    std::array<Index, 3> end = {count(u[k]), u[k], p[k]};
    const std::size_t l = (k + 1) % 3;
    std::array<Index, 3> other = {count(u[l]), u[l], p[l]};
    if (other < end) std::swap(end, other);
    if (end[1] == uv) edges.push_back({end[2], other[2], other[1], face});
  }
}

}  // namespace onmesh
