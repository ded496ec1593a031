#include "onmesh/nodes/bridge.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "onmesh/mesh/closest_point.h"
#include "onmesh/mesh/components.h"
#include "onmesh/mesh/gap_search.h"
#include "onmesh/nodes/overlay_lookup.h"

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

/// Nodes on boundaries, and what lies across gaps from there.
class BoundaryNodes {
 public:
  BoundaryNodes(const TriangleMesh& mesh, const GapSearch& gaps) : mesh_(mesh), gaps_(gaps) {}

  /// The closest point of a boundary across a gap from the node, if it lies on one itself.
  /// \param number of the node: vertices of the mesh come first
  std::optional<SurfacePoint> across(Index number, const SurfacePoint& node, double width) const {
    std::optional<BoundaryPoint> best;
    double least = std::numeric_limits<double>::infinity();
    const Vec3 here = mesh_.position(node);
    for (const BoundaryPoint& from : places(number, node)) {
      const auto there = gaps_.across(from, width);
      if (!there) continue;
      const double d2 = (gaps_.position(*there) - here).squaredNorm();
      if (d2 >= least) continue;
      least = d2;
      best = there;
    }
    return best ? std::optional(gaps_.surface_point(*best)) : std::nullopt;
  }

 private:
  std::vector<BoundaryPoint> places(Index number, const SurfacePoint& node) const {
    std::vector<BoundaryPoint> places;
    if (number < mesh_.positions.size()) {
      for (const Index e : gaps_.at_vertex(number))
        places.push_back({e, gaps_.edges()[e].ends[0] == number ? 0.0 : 1.0});
      return places;
    }
    for (Index k = 0; k < 3; ++k) {
      const Index e = gaps_.edge_of(node.face, k);
      constexpr double kOnEdge = 1e-9;
      if (e == kNone || node.barycentric[(k + 2) % 3] > kOnEdge) continue;
      places.push_back({e, node.barycentric[(k + 1) % 3]});
    }
    return places;
  }

  const TriangleMesh& mesh_;
  const GapSearch& gaps_;
};

}  // namespace

Index add_bridges(const TriangleMesh& mesh, double width, NodeSurface& surface) {
  NodeMesh& nodes = surface.nodes;
  const FaceComponents components = connected_components(mesh);
  const std::vector<Index>& component = components.of_face;
  std::vector<Eigen::AlignedBox3d> boxes(components.count);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const Vec3& p : mesh.corners(f)) boxes[component[f]].extend(p);
  }
  const std::vector<bool> close = find_close(boxes, width);
  const bool any_close = std::find(close.begin(), close.end(), true) != close.end();
  const GapSearch gaps(mesh);
  if (!any_close && gaps.edges().empty()) return 0;

  // For every node the node face across the gap.
  std::optional<ClosestPoint> closest_point;
  if (any_close) closest_point.emplace(mesh);
  const BoundaryNodes boundary(mesh, gaps);
  const OverlayLookup overlay(surface.overlay);
  std::vector<Index> across(nodes.nodes.size(), kNone);
  tbb::parallel_for(std::size_t{0}, across.size(), [&](std::size_t n) {
    const SurfacePoint& node = nodes.nodes[n];
    if (node.face == kNone) return;
    std::optional<SurfacePoint> nearest;
    if (close[component[node.face]]) {
      nearest =
          closest_point->closest_other(mesh.position(node), width, component, component[node.face]);
    }
    if (!nearest) nearest = boundary.across(Index(n), node, width);
    if (nearest) across[n] = overlay.locate(*nearest).face;
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
