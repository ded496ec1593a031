#include "onmesh/poisson/connected_ball.h"

#include <algorithm>
#include <numeric>

#include "onmesh/base/triangle.h"

namespace onmesh {

ConnectedBall::Joins ConnectedBall::make_joins(const TriangleMesh& mesh) {
  Joins joins;
  const std::size_t corners = 3 * mesh.faces.size();
  // Edges: corners sorted by their end points; runs of equal ends are one edge.
  std::vector<std::uint64_t> ends(corners);
  for (std::size_t c = 0; c < corners; ++c) {
    const auto& f = mesh.faces[c / 3];
    const auto [low, high] = std::minmax(f[c % 3], f[(c + 1) % 3]);
    ends[c] = std::uint64_t(low) << 32 | high;
  }
  std::vector<std::size_t> order(corners);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return ends[a] != ends[b] ? ends[a] < ends[b] : a < b;
  });
  joins.corner_edges.resize(corners);
  joins.edge_faces.resize(corners);
  for (std::size_t i = 0; i < corners; ++i) {
    if (i == 0 || ends[order[i]] != ends[order[i - 1]]) joins.edge_offsets.push_back(Index(i));
    joins.corner_edges[order[i]] = Index(joins.edge_offsets.size() - 1);
    joins.edge_faces[i] = Index(order[i] / 3);
  }
  joins.edge_offsets.push_back(Index(corners));

  joins.vertex_offsets.assign(mesh.positions.size() + 1, 0);
  for (const auto& f : mesh.faces)
    for (const Index v : f) ++joins.vertex_offsets[v + 1];
  std::partial_sum(joins.vertex_offsets.begin(), joins.vertex_offsets.end(),
                   joins.vertex_offsets.begin());
  joins.vertex_faces.resize(corners);
  std::vector<Index> next(joins.vertex_offsets.begin(), joins.vertex_offsets.end() - 1);
  for (std::size_t c = 0; c < corners; ++c)
    joins.vertex_faces[next[mesh.faces[c / 3][c % 3]]++] = Index(c / 3);
  return joins;
}

ConnectedBall::ConnectedBall(const TriangleMesh& mesh)
    : mesh_(&mesh),
      joins_(std::make_shared<const Joins>(make_joins(mesh))),
      face_marks_(mesh.faces.size(), 0),
      edge_marks_(joins_->edge_offsets.size() - 1, 0),
      vertex_marks_(mesh.positions.size(), 0) {}

void ConnectedBall::start_marks() {
  if (++mark_ != 0) return;
  // The counter wrapped around: marks of 2^32 calls ago must not count.
  for (auto* marks : {&face_marks_, &edge_marks_, &vertex_marks_})
    std::fill(marks->begin(), marks->end(), 0);
  mark_ = 1;
}

void ConnectedBall::add(Index face) {
  if (face_marks_[face] == mark_) return;
  face_marks_[face] = mark_;
  result_.push_back(face);
}

const std::vector<Index>& ConnectedBall::find(Index face, const Vec3& centre, double radius) {
  start_marks();
  result_.clear();
  add(face);
  const double limit = radius * radius;
  for (std::size_t i = 0; i < result_.size(); ++i) {
    const Index f = result_[i];
    const auto& v = mesh_->faces[f];
    std::array<bool, 3> inside;
    for (std::size_t k = 0; k < 3; ++k) {
      inside[k] = (mesh_->positions[v[k]] - centre).squaredNorm() < limit;
      if (!inside[k] || vertex_marks_[v[k]] == mark_) continue;
      vertex_marks_[v[k]] = mark_;
      for (Index j = joins_->vertex_offsets[v[k]]; j < joins_->vertex_offsets[v[k] + 1]; ++j)
        add(joins_->vertex_faces[j]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      if (inside[k] || inside[l]) continue;  // all its faces came with that vertex
      const Index e = joins_->corner_edges[3 * std::size_t(f) + k];
      if (edge_marks_[e] == mark_) continue;
      edge_marks_[e] = mark_;
      if (squared_distance_to_segment(centre, mesh_->positions[v[k]], mesh_->positions[v[l]]) <
          limit)
        for (Index j = joins_->edge_offsets[e]; j < joins_->edge_offsets[e + 1]; ++j)
          add(joins_->edge_faces[j]);
    }
  }
  return result_;
}

}  // namespace onmesh
