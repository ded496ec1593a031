#include "onmesh/atlas/uv_neighbours.h"

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

}  // namespace onmesh
