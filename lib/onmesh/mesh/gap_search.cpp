#include "onmesh/mesh/gap_search.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

/// So many times as far along the boundary as straight is across a gap.
constexpr double kMuchLonger = 4;

std::vector<SegmentTree::Segment> segments(const TriangleMesh& mesh,
                                           const std::vector<BoundaryEdge>& edges) {
  std::vector<SegmentTree::Segment> segments;
  for (const BoundaryEdge& e : edges)
    segments.push_back({mesh.positions[e.ends[0]], mesh.positions[e.ends[1]]});
  return segments;
}

}  // namespace

GapSearch::GapSearch(const TriangleMesh& mesh)
    : mesh_(mesh),
      edges_(boundary_edges(mesh)),
      at_vertex_(edges_, mesh.positions.size()),
      tree_(segments(mesh, edges_)),
      edge_of_side_(3 * mesh.faces.size(), kNone),
      places_(edges_.size()),
      lengths_(edges_.size()) {
  for (Index e = 0; e < edges_.size(); ++e) {
    const auto& ends = edges_[e].ends;
    edge_of_side_[3 * std::size_t{edges_[e].face} + edges_[e].corner] = e;
    lengths_[e] = (mesh.positions[ends[1]] - mesh.positions[ends[0]]).norm();
  }
  for (Index e = 0; e < edges_.size(); ++e) {
    if (places_[e].line == kNone) follow(e);
  }
}

/// Boundaries that do not close count as if they did: their ends meet others there.
void GapSearch::follow(Index first) {
  const auto line = static_cast<Index>(totals_.size());
  double done = 0;
  Index edge = first, at = edges_[first].ends[0];
  while (edge != kNone) {
    const auto& ends = edges_[edge].ends;
    const bool forward = ends[0] == at;
    places_[edge] = {line, forward ? done : done + lengths_[edge], forward ? 1.0 : -1.0};
    done += lengths_[edge];
    at = ends[forward ? 1 : 0];
    edge = kNone;
    for (const Index next : at_vertex_.at(at)) {
      if (places_[next].line == kNone) {
        edge = next;
        break;
      }
    }
  }
  totals_.push_back(done);
}

double GapSearch::along(const BoundaryPoint& p) const {
  const Place& place = places_[p.edge];
  return place.start + place.sense * p.position * lengths_[p.edge];
}

Vec3 GapSearch::position(const BoundaryPoint& p) const {
  const auto& ends = edges_[p.edge].ends;
  const Vec3& a = mesh_.positions[ends[0]];
  return a + p.position * (mesh_.positions[ends[1]] - a);
}

SurfacePoint GapSearch::surface_point(const BoundaryPoint& p) const {
  const BoundaryEdge& edge = edges_[p.edge];
  SurfacePoint point{edge.face, Vec3::Zero()};
  point.barycentric[edge.corner] = 1 - p.position;
  point.barycentric[(edge.corner + 1) % 3] = p.position;
  return point;
}

/// On another boundary, or much farther along this one than straight.
bool GapSearch::is_across(const BoundaryPoint& from, const BoundaryPoint& to,
                          double distance) const {
  if (from.edge == to.edge) return false;
  const BoundaryEdge &e = edges_[from.edge], &o = edges_[to.edge];
  const bool same_line = places_[from.edge].line == places_[to.edge].line;
  for (const Index v : e.ends) {
    if (v != o.ends[0] && v != o.ends[1]) continue;
    // Where boundaries touch, lengths along them mean nothing.
    if (!same_line || at_vertex_.at(v).size() > 2) return false;
  }
  if (!same_line) return true;
  const double way = std::abs(along(from) - along(to));
  const double around = totals_[places_[from.edge].line] - way;
  return std::min(way, around) > kMuchLonger * distance;
}

bool GapSearch::is_other_side(Index edge, Index other, double distance) const {
  constexpr double kThickness = 1.5;
  const BoundaryEdge &e = edges_[edge], &o = edges_[other];
  return lie_on_each_other(mesh_.corners(e.face), mesh_.corners(o.face), mesh_.positions[e.ends[0]],
                           mesh_.positions[e.ends[1]], kThickness * distance);
}

double GapSearch::gap_at(Index edge, double width) const {
  const auto& points = mesh_.positions;
  const Vec3 &a = points[edges_[edge].ends[0]], &b = points[edges_[edge].ends[1]];
  double least = width;
  Index nearest = kNone;
  tree_.visit_near(a, b, width, [&](Index other) {
    for (std::size_t end = 0; end < 2; ++end) {
      BoundaryPoint from{edge, 0};
      const double d = std::sqrt(
          squared_distance_to_segment(points[edges_[other].ends[end]], a, b, &from.position));
      if (!(d <= least) || (nearest != kNone && d == least && nearest < other)) continue;
      if (!is_across(from, {other, static_cast<double>(end)}, d)) continue;
      least = d;
      nearest = other;
    }
    return least;
  });
  return nearest == kNone || is_other_side(edge, nearest, least) ? -1 : least;
}

std::optional<BoundaryPoint> GapSearch::across(const BoundaryPoint& from, double width) const {
  const Vec3 point = position(from);
  std::optional<BoundaryPoint> best;
  double least = width;
  tree_.visit_near(point, point, width, [&](Index other) {
    const auto& ends = edges_[other].ends;
    BoundaryPoint to{other, 0};
    const double d = std::sqrt(squared_distance_to_segment(point, mesh_.positions[ends[0]],
                                                           mesh_.positions[ends[1]], &to.position));
    if (!(d <= least) || (best && d == least && best->edge < other)) return least;
    if (!is_across(from, to, d)) return least;
    least = d;
    best = to;
    return least;
  });
  if (best && is_other_side(from.edge, best->edge, least)) return std::nullopt;
  return best;
}

}  // namespace onmesh
