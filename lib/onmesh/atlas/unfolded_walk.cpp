#include "onmesh/atlas/unfolded_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "onmesh/atlas/uv_triangle.h"
#include "onmesh/base/parallel.h"
#include "onmesh/base/plane.h"

namespace onmesh {
namespace {

constexpr int kMostSteps = 1024;
constexpr double kInside = -1e-9;  // barycentric

std::size_t next(std::size_t k) { return (k + 1) % 3; }

/// Where the way from a to b crosses the edge from p to q, or the end of that which is closer.
Vec2 point_on_way(const Vec2& a, const Vec2& b, const Vec2& p, const Vec2& q) {
  const double side_p = twice_area(a, b, p), side_q = twice_area(a, b, q);
  const double t = side_p == side_q ? 0 : std::clamp(side_p / (side_p - side_q), 0.0, 1.0);
  return p + t * (q - p);
}

}  // namespace

UnfoldedWalk::UnfoldedWalk(const TriangleMesh& mesh, const TexelMap& map, double bridge)
    : mesh_(mesh), map_(map), bridge_(bridge), across_(3 * mesh.faces.size(), kNone) {
  if (bridge > 0) gaps_.emplace(mesh);
  std::vector<Index> offsets(mesh.positions.size() + 1, 0);
  for (const auto& face : mesh.faces)
    for (const Index v : face) ++offsets[v + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<Index> around(offsets.back());
  std::vector<Index> end(offsets.begin(), offsets.end() - 1);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (const Index v : mesh.faces[f]) around[end[v]++] = f;
  std::vector<Index> in_chart(across_.size(), kNone);
  parallel_over(mesh.faces.size(), [&](std::size_t f) {
    std::vector<Index> others;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.faces[f][k], b = mesh.faces[f][next(k)];
      if (a == b) continue;
      others.clear();
      const Index v = offsets[a + 1] - offsets[a] <= offsets[b + 1] - offsets[b] ? a : b;
      for (Index i = offsets[v]; i < offsets[v + 1]; ++i) {
        const Index g = around[i];
        if (g == f) continue;
        for (std::size_t l = 0; l < 3; ++l) {
          const Index c = mesh.faces[g][l], d = mesh.faces[g][next(l)];
          if ((c == a && d == b) || (c == b && d == a)) others.push_back(Index(3 * g + l));
        }
      }
      double straightest = -2, straightest_in_chart = -2;
      for (const Index other : others) {
        const Index g = other / 3;
        const double cosine = others.size() == 1 ? 1 : straightness(Index(f), k, g, other % 3);
        if (cosine > straightest) {
          straightest = cosine;
          across_[3 * f + k] = other;
        }
        if (cosine > straightest_in_chart && uvs_agree(Index(f), k, g, other % 3)) {
          straightest_in_chart = cosine;
          in_chart[3 * f + k] = other;
        }
      }
    }
  });
  for (Index i = 0; i < across_.size(); ++i)
    if (in_chart[i] != across_[i]) in_chart_.emplace_back(i, in_chart[i]);
}

/// The cosine of the angle by which the surface turns from a face into another over an edge.
double UnfoldedWalk::straightness(Index face, std::size_t k, Index other, std::size_t l) const {
  const auto p = mesh_.corners(face), q = mesh_.corners(other);
  const Vec3 along = (p[next(k)] - p[k]).normalized();
  const auto off_edge = [&](const Vec3& apex) {
    const Vec3 d = apex - p[k];
    return Vec3(d - d.dot(along) * along);
  };
  const Vec3 in = off_edge(p[(k + 2) % 3]), out = off_edge(q[(l + 2) % 3]);
  const double norms = in.norm() * out.norm();
  // A face without area is the last choice.
  return norms > 0 ? -in.dot(out) / norms : -1;
}

Index UnfoldedWalk::across_in_chart(Index face, int k) const {
  const auto i = Index(side(face, k));
  const auto at = std::lower_bound(in_chart_.begin(), in_chart_.end(), std::pair(i, Index{0}));
  return at != in_chart_.end() && at->first == i ? at->second : across_[i];
}

bool UnfoldedWalk::uvs_agree(Index face, std::size_t k, Index other, std::size_t l) const {
  const auto &uvs = mesh_.face_uvs[face], &other_uvs = mesh_.face_uvs[other];
  if (uvs[k] == kNone || uvs[next(k)] == kNone) return false;
  const bool opposed = mesh_.faces[face][k] == mesh_.faces[other][next(l)];
  return opposed ? uvs[k] == other_uvs[next(l)] && uvs[next(k)] == other_uvs[l]
                 : uvs[k] == other_uvs[l] && uvs[next(k)] == other_uvs[next(l)];
}

std::array<Vec2, 3> UnfoldedWalk::pixel_corners(Index face) const {
  const TexelTile tile = map_.tile_of(face);
  std::array<Vec2, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = to_pixels(mesh_.uvs[mesh_.face_uvs[face][k]], tile.width, tile.height);
  return corners;
}

LaidFace UnfoldedWalk::lay_out(Index face) const {
  const auto p = mesh_.corners(face);
  const Vec3 e = p[1] - p[0], d = p[2] - p[0];
  const double length = e.norm();
  LaidFace laid;
  laid.face = face;
  laid.corners = {Vec2(0, 0), Vec2(length, 0), Vec2(e.dot(d) / length, e.cross(d).norm() / length)};
  return laid;
}

template <bool by_uv>
std::array<Vec2, 3> UnfoldedWalk::steering_corners(const LaidFace& laid) const {
  if constexpr (by_uv)
    return pixel_corners(laid.face);
  else
    return laid.corners;
}

/// Unfold the face across edge k onto the other side of that edge.
template <bool by_uv>
std::optional<LaidFace> UnfoldedWalk::cross(const LaidFace& laid, int k) const {
  const Index other = by_uv ? across_in_chart(laid.face, k) : across(laid.face, k);
  if (other == kNone) return std::nullopt;
  const Index g = other / 3;
  if (by_uv && !mesh_.has_uvs(g)) return std::nullopt;
  const std::size_t a = std::size_t(k), l = other % 3;
  const bool opposed = mesh_.faces[laid.face][a] == mesh_.faces[g][next(l)];
  const auto p = mesh_.corners(g);
  const Vec3 e = p[next(l)] - p[l], d = p[(l + 2) % 3] - p[l];
  const double length2 = e.squaredNorm();
  if (!(length2 > 0)) return std::nullopt;
  LaidFace result;
  result.face = g;
  result.winding = opposed ? laid.winding : -laid.winding;
  result.corners[l] = laid.corners[opposed ? next(a) : a];
  result.corners[next(l)] = laid.corners[opposed ? a : next(a)];
  const Vec2 along = result.corners[next(l)] - result.corners[l];
  const Vec2 left(-along.y(), along.x());
  result.corners[(l + 2) % 3] = result.corners[l] + e.dot(d) / length2 * along +
                                result.winding * e.cross(d).norm() / length2 * left;
  return result;
}

/// Leave `start` over the edge and go on to the face that holds `to`.
template <bool by_uv>
WalkEnd UnfoldedWalk::walk_out(const LaidFace& start, int edge, const Vec2& from,
                               const Vec2& to) const {
  WalkEnd end{start, from, false};
  for (int step = 0; step < kMostSteps; ++step) {
    const Index entered =
        by_uv ? across_in_chart(end.laid.face, edge) : across(end.laid.face, edge);
    const auto onward = cross<by_uv>(end.laid, edge);
    if (!onward) {
      end.barred = edge;
      break;
    }
    end.laid = *onward;
    const auto corners = steering_corners<by_uv>(end.laid);
    const bool can_hold = !by_uv || map_.chart_of_face[end.laid.face] != kNone;
    if (can_hold && barycentric_in(corners, to).minCoeff() >= kInside) {
      end.point = to;
      end.arrived = true;
      return end;
    }
    // The way passes between the entered edge's ends a and b; the side of the apex c tells which
    // other edge it leaves by. It may start in a or b, so go by the end further from the way.
    const std::size_t a = entered % 3, b = next(a), c = next(b);
    const double side_a = twice_area(from, to, corners[a]),
                 side_b = twice_area(from, to, corners[b]);
    const double side_c = twice_area(from, to, corners[c]);
    const bool by_b =
        std::abs(side_b) >= std::abs(side_a) ? side_b * side_c <= 0 : side_a * side_c > 0;
    const std::size_t exit = by_b ? b : c;
    edge = int(exit);
    end.point = point_on_way(from, to, corners[exit], corners[next(exit)]);
  }
  return end;
}

template <bool by_uv>
WalkEnd UnfoldedWalk::walk(const LaidFace& start, const Vec2& from, const Vec2& to) const {
  const auto corners = steering_corners<by_uv>(start);
  const Vec3 b = barycentric_in(corners, to);
  if (!b.allFinite()) return {start, from, false};
  if (b.minCoeff() >= kInside) return {start, to, true};
  // Beyond which edges does `to` lie? Edge k is opposite to corner k + 2.
  std::array<std::size_t, 2> beyond{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (b[Eigen::Index((k + 2) % 3)] < kInside && count < 2) beyond[count++] = k;
  if (count == 1) return walk_out<by_uv>(start, int(beyond[0]), from, to);
  // Beyond two: their common corner lies left or right of the way.
  const std::size_t first = next(beyond[0]) == beyond[1] ? beyond[0] : beyond[1];
  const std::size_t corner = next(first);
  const double winding = twice_area(corners[0], corners[1], corners[2]) > 0 ? 1 : -1;
  const double side = winding * twice_area(from, to, corners[corner]);
  const std::size_t choice = side > 0 ? first : corner;
  WalkEnd result = walk_out<by_uv>(start, int(choice), from, to);
  const bool through_corner =
      std::abs(side) <= 1e-9 * (to - from).norm() * (corners[0] - corners[1]).norm();
  if (result.arrived || !through_corner) return result;
  return walk_out<by_uv>(start, int(side > 0 ? corner : first), from, to);
}

WalkEnd UnfoldedWalk::over_surface(const LaidFace& start, const Vec2& from, const Vec2& to) const {
  return walk<false>(start, from, to);
}

WalkEnd UnfoldedWalk::over_edge(const LaidFace& start, int k, const Vec2& from,
                                const Vec2& to) const {
  if (!(barycentric_in(start.corners, to)[(k + 2) % 3] < kInside))
    return over_surface(start, from, to);
  WalkEnd end = walk_out<false>(start, k, from, to);
  if (end.arrived) return end;
  WalkEnd other = over_surface(start, from, to);
  if (other.arrived) return other;
  if (const auto beyond = over_gap(end, to)) return *beyond;
  return over_gap(other, to).value_or(end);
}

/// Go on across the gap that the way ends at, if there is a bridge.
std::optional<WalkEnd> UnfoldedWalk::over_gap(const WalkEnd& barred, const Vec2& to) const {
  if (!gaps_ || barred.barred < 0) return std::nullopt;
  const auto k = std::size_t(barred.barred);
  const Index edge = gaps_->edge_of(barred.laid.face, Index(k));
  if (edge == kNone) return std::nullopt;
  BoundaryPoint here{edge, 0};
  squared_distance_to_segment(barred.point, barred.laid.corners[k], barred.laid.corners[next(k)],
                              &here.position);
  const auto there = gaps_->across(here, bridge_);
  if (!there) return std::nullopt;
  Vec2 landing;
  const LaidFace laid = lay_out_across(barred, *there, landing);
  // What lies over the gap belongs to its nearer side.
  if ((to - barred.point).norm() < (to - landing).norm()) return std::nullopt;
  WalkEnd end = over_surface(laid, landing, to);
  if (!end.arrived && end.barred >= 0 && end.laid.face == laid.face) {
    // Barred before another face was entered: go on to where the face ends.
    const auto exit = std::size_t(end.barred);
    end.point = point_on_way(landing, to, laid.corners[exit], laid.corners[next(exit)]);
  }
  return end;
}

/// The face beyond the gap, in the plane of the one before it: its edge as far away and turned as
/// much as it is in space, the face itself on the far side of that.
/// \param point receives where the way lands
LaidFace UnfoldedWalk::lay_out_across(const WalkEnd& barred, const BoundaryPoint& there,
                                      Vec2& point) const {
  const auto k = std::size_t(barred.barred);
  const auto p = mesh_.corners(barred.laid.face);
  const Vec3 along = (p[next(k)] - p[k]).normalized();
  Vec3 out = p[k] - p[(k + 2) % 3];
  out = (out - out.dot(along) * along).normalized();
  const auto& plane = barred.laid.corners;
  const Vec2 along2 = (plane[next(k)] - plane[k]).normalized();
  const Vec2 out2 = barred.laid.winding * Vec2(along2.y(), -along2.x());

  const BoundaryEdge& edge = gaps_->edges()[there.edge];
  const std::size_t l = edge.corner;
  const auto q = mesh_.corners(edge.face);
  const Vec3 side = q[next(l)] - q[l], apex = q[(l + 2) % 3] - q[l];
  const double length = side.norm();
  const Vec3 gap = gaps_->position(there) - (p[k] + (barred.point - plane[k]).dot(along2) * along);
  const double ahead = gap.dot(along);
  point = barred.point + ahead * along2 + (gap - ahead * along).norm() * out2;
  const double turned = side.dot(along) / length;
  const double rise = std::sqrt(std::max(0.0, 1 - turned * turned));
  const Vec2 side2 = turned * along2 + (side.dot(out) < 0 ? -rise : rise) * out2;
  Vec2 inward(-side2.y(), side2.x());
  LaidFace laid;
  laid.face = edge.face;
  // An edge that runs away from this one lies beside its face as it does in space.
  const Vec3 inward3 = apex - side.dot(apex) / (length * length) * side;
  const bool parallel = std::abs(turned) > rise;
  const Vec2 wanted = parallel ? out2 : Vec2(inward3.dot(along) * along2 + inward3.dot(out) * out2);
  laid.winding = inward.dot(wanted) < 0 ? -1 : 1;
  inward *= laid.winding;
  laid.corners[l] = point - there.position * length * side2;
  laid.corners[next(l)] = laid.corners[l] + length * side2;
  laid.corners[(l + 2) % 3] =
      laid.corners[l] + side.dot(apex) / length * side2 + side.cross(apex).norm() / length * inward;
  return laid;
}

std::optional<LaidFace> UnfoldedWalk::within_chart(const LaidFace& start, const Vec2& from,
                                                   const Vec2& to) const {
  const WalkEnd end = walk<true>(start, from, to);
  if (!end.arrived) return std::nullopt;
  return end.laid;
}

}  // namespace onmesh
