#include "onmesh/nodes/cut_edges.h"

namespace onmesh {

void CutEdges::add(std::vector<Side> sides) {
  edges_.push_back(std::move(sides));
  name(Index(edges_.size() - 1));
}

void CutEdges::name(Index edge) {
  for (const Side& side : edges_[edge]) {
    if (side.tail >= edge_at_.size()) edge_at_.resize(2 * std::size_t(side.tail) + 1, kNone);
    edge_at_[side.tail] = edge;
  }
}

std::span<const CutEdges::Side> CutEdges::sides(Index tail) const {
  if (tail >= edge_at_.size() || edge_at_[tail] == kNone) return {};
  return edges_[edge_at_[tail]];
}

void CutEdges::split(Index tail, const std::vector<Index>& middles) {
  const Index edge = edge_at_[tail];
  std::vector<Side> near, far;  // of the end that forward sides start from
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const Side& side = edges_[edge][i];
    (side.forward ? near : far).push_back(side);
    (side.forward ? far : near).push_back({middles[i], side.forward});
  }
  edges_[edge] = std::move(near);
  name(edge);
  add(std::move(far));
  middles_.push_back(middles);
}

}  // namespace onmesh
