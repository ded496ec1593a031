#include "onmesh/patches/edge_extents.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace onmesh {

std::vector<double> edge_extents(const NodeMesh& mesh) {
  constexpr double kSlope = 1.0 / 7;
  std::vector<double> extents(mesh.nodes.size(), 0);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& l = mesh.lengths[f];
    const double longest = std::max({l[0], l[1], l[2]});
    for (const Index n : mesh.faces[f]) extents[n] = std::max(extents[n], longest);
  }
  // Nodes that raise a neighbour, the highest first.
  std::priority_queue<std::pair<double, Index>> queue;
  const auto raise_around = [&](Index n) {
    for (Index at = mesh.node_offsets[n]; at < mesh.node_offsets[n + 1]; ++at) {
      const Index f = mesh.node_faces[at];
      for (int k = 0; k < 3; ++k) {
        const Index a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
        if (a != n && b != n) continue;
        const Index to = a == n ? b : a;
        const double there = extents[n] - kSlope * mesh.lengths[f][k];
        if (!(there > extents[to] * (1 + 1e-6))) continue;
        extents[to] = there;
        queue.emplace(there, to);
      }
    }
  };
  for (Index n = 0; n < extents.size(); ++n) raise_around(n);
  while (!queue.empty()) {
    const auto [extent, n] = queue.top();
    queue.pop();
    if (extent == extents[n]) raise_around(n);
  }
  return extents;
}

}  // namespace onmesh
