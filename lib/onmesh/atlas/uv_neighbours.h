// Which faces of a chart share an edge or a corner (internal).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// The faces around each UV index, to find who shares an edge or a corner of a chart: there both
/// the vertex and the UV index are the same.
class UvNeighbours {
 public:
  /// \param used faces to look among, all with UVs
  /// \pre mesh outlives this
  UvNeighbours(const TriangleMesh& mesh, const std::vector<bool>& used);

  /// Call visit(face) for every other face that has edge k of the face, with equal UVs, in
  /// ascending order.
  template <class Visit>
  void across_edge(Index face, int k, Visit&& visit) const {
    const int l = (k + 1) % 3;
    const auto& p = mesh_.faces[face];
    const auto& u = mesh_.face_uvs[face];
    const std::size_t a = std::size_t(k), b = std::size_t(l);
    const Index around = count(u[a]) <= count(u[b]) ? u[a] : u[b];
    for (Index i = offsets_[around]; i < offsets_[around + 1]; ++i) {
      const Index other = faces_[i];
      if (other != face && has_corner(other, p[a], u[a]) && has_corner(other, p[b], u[b]) &&
          (i == offsets_[around] || faces_[i - 1] != other))
        visit(other);
    }
  }

  /// Call work(faces) for every edge that several faces have with equal UVs, in ascending order.
  /// Unlike across_edge() for all faces, it takes no longer where many of them coincide.
  template <class Work>
  void each_shared_edge(Work&& work) const {
    // The edges at a UV, as position, other position, other UV and face.
    std::vector<std::array<Index, 4>> edges;
    std::vector<Index> sharing;
    for (Index uv = 0; uv + 1 < offsets_.size(); ++uv) {
      edges.clear();
      for (Index i = offsets_[uv]; i < offsets_[uv + 1]; ++i) {
        if (i == offsets_[uv] || faces_[i - 1] != faces_[i]) add_edges(faces_[i], uv, edges);
      }
      std::sort(edges.begin(), edges.end());
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto is_same = [&](std::size_t j) {
          return std::equal(edges[i].begin(), edges[i].end() - 1, edges[j].begin());
        };
        sharing.push_back(edges[i][3]);
        if (i + 1 < edges.size() && is_same(i + 1)) continue;
        if (sharing.size() > 1) work(sharing);
        sharing.clear();
      }
    }
  }

  /// Call visit(face) for every other face that has corner k of the face, with an equal UV.
  template <class Visit>
  void around_corner(Index face, int k, Visit&& visit) const {
    const Index p = mesh_.faces[face][std::size_t(k)], u = mesh_.face_uvs[face][std::size_t(k)];
    for (Index i = offsets_[u]; i < offsets_[u + 1]; ++i)
      if (faces_[i] != face && has_corner(faces_[i], p, u)) visit(faces_[i]);
  }

 private:
  Index count(Index uv) const { return offsets_[uv + 1] - offsets_[uv]; }
  /// The edges of a face that belong to a UV: that of their ends with fewer faces around it.
  void add_edges(Index face, Index uv, std::vector<std::array<Index, 4>>& edges) const;
  bool has_corner(Index face, Index position, Index uv) const {
    const auto& p = mesh_.faces[face];
    const auto& u = mesh_.face_uvs[face];
    return (p[0] == position && u[0] == uv) || (p[1] == position && u[1] == uv) ||
           (p[2] == position && u[2] == uv);
  }

  const TriangleMesh& mesh_;
  std::vector<Index> offsets_, faces_;  // faces around UV i: faces_[offsets_[i], offsets_[i + 1])
};

}  // namespace onmesh
