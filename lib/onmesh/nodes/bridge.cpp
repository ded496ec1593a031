#include "onmesh/nodes/bridge.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "onmesh/mesh/closest_point.h"
#include "onmesh/mesh/components.h"

namespace onmesh {
namespace {

/// Which components have another one's bounding box within `width` of their own: the others need
/// no search.
std::vector<bool> find_close(const std::vector<Eigen::AlignedBox3d>& boxes, double width) {
  // Sorted by their lower x, a box meets only those that begin before it ends.
  std::vector<Index> order(boxes.size());
  for (Index i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::pair(boxes[a].min().x(), a) < std::pair(boxes[b].min().x(), b);
  });
  std::vector<bool> close(boxes.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const auto& other = boxes[order[j]];
      if (other.min().x() > box.max().x() + width) break;
      if (box.squaredExteriorDistance(other) > width * width) continue;
      close[order[i]] = close[order[j]] = true;
    }
  }
  return close;
}

}  // namespace

Index add_bridges(const TriangleMesh& mesh, double width, NodeSurface& surface) {
  NodeMesh& nodes = surface.nodes;
  const FaceComponents components = connected_components(mesh);
  const std::vector<Index>& component = components.of_face;
  if (components.count < 2) return 0;
  std::vector<Eigen::AlignedBox3d> boxes(components.count);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const Vec3& p : mesh.corners(f)) boxes[component[f]].extend(p);
  }
  const std::vector<bool> close = find_close(boxes, width);
  if (std::find(close.begin(), close.end(), true) == close.end()) return 0;

  // For every node the node face across the gap.
  const ClosestPoint closest_point(mesh);
  std::vector<Index> across(nodes.nodes.size(), kNone);
  tbb::parallel_for(std::size_t{0}, across.size(), [&](std::size_t n) {
    const SurfacePoint& node = nodes.nodes[n];
    if (node.face == kNone || !close[component[node.face]]) return;
    const auto nearest =
        closest_point.closest_other(mesh.position(node), width, component, component[node.face]);
    if (nearest) across[n] = surface.overlay.locate(*nearest).face;
  });

  Index bridges = 0;
  for (Index a = 0; a < across.size(); ++a) {
    if (across[a] == kNone) continue;
    const std::array<Index, 3> base = nodes.faces[across[a]];
    const std::array<double, 3> sides = nodes.lengths[across[a]];
    std::array<double, 3> up;
    for (std::size_t k = 0; k < 3; ++k) {
      up[k] = (mesh.position(nodes.nodes[base[k]]) - mesh.position(nodes.nodes[a])).norm();
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      nodes.faces.push_back({a, base[k], base[l]});
      nodes.lengths.push_back({up[k], sides[k], up[l]});
      if (!nodes.neighbours.empty()) nodes.neighbours.push_back({kNone, kNone, kNone});
    }
    ++bridges;
  }
  nodes.bridge_faces += 3 * bridges;
  nodes.build_incidence();
  return bridges;
}

}  // namespace onmesh
