#include "onmesh/nodes/input_surface.h"

#include <algorithm>
#include <cmath>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

Vec2 rotated(const Vec2& v, const Vec2& by) {
  return {v.x() * by.x() - v.y() * by.y(), v.x() * by.y() + v.y() * by.x()};
}

}  // namespace

InputSurface::InputSurface(HalfEdges edges, Index vertices) : edges_(std::move(edges)) {
  mollify(edges_);
  outgoing_.assign(vertices, kNone);
  boundary_.assign(vertices, 0);
  total_angle_.assign(vertices, 0);
  for (Index h = 0; h < edges_.tail.size(); ++h) {
    const Index v = edges_.tail[h];
    const bool clockwise_most = edges_.twin[h] == kNone;
    if (outgoing_[v] == kNone || clockwise_most) outgoing_[v] = h;
    if (clockwise_most) boundary_[v] = boundary_[edges_.tip(h)] = 1;
  }

  direction_.assign(edges_.tail.size(), 0);
  for (Index v = 0; v < vertices; ++v) {
    if (outgoing_[v] == kNone) continue;  // isolated
    Index h = outgoing_[v];
    double angle = 0;
    do {
      direction_[h] = angle;
      angle += edges_.corner_angle(h);
      h = edges_.rotate(h);
    } while (h != kNone && h != outgoing_[v]);
    total_angle_[v] = angle;
  }

  layout_.resize(edges_.face_count());
  for (Index f = 0; f < layout_.size(); ++f) layout_[f] = edges_.layout(f);
}

/// Who walks over the surface, in the layout of one face after the other.
struct InputSurface::Walker {
  Index face;
  Vec2 at, heading;
  /// The edge that the walk came in by, which it does not leave by.
  Index entry = kNone;
  std::array<bool, 3> may_leave{true, true, true};
};

// Into the face whose wedge at the vertex holds the direction.
InputSurface::Walker InputSurface::start(Index vertex, double direction) const {
  if (boundary_[vertex] == 0 && direction >= total_angle_[vertex])
    direction -= total_angle_[vertex];
  Index h = outgoing_[vertex];
  const Index first = h;
  for (Index next = edges_.rotate(h);
       next != kNone && next != first && direction_[next] <= direction; next = edges_.rotate(h)) {
    h = next;
  }
  const Index f = HalfEdges::face(h), k = h % 3;
  const Vec2& at = layout_[f][k];
  const double turn = direction - direction_[h];
  const Vec2 heading =
      rotated((layout_[f][(k + 1) % 3] - at).normalized(), {std::cos(turn), std::sin(turn)});
  return {f, at, heading, kNone, {k == 2, k == 0, k == 1}};  // out by the edge opposite the corner
}

// The edge that the walker leaves the face by before it has gone the distance, which then becomes
// that to the edge; kNone if it stays.
Index InputSurface::exit_of(const Walker& walker, double& distance) const {
  const auto& corner = layout_[walker.face];
  Index leave = kNone;
  for (Index k = 0; k < 3; ++k) {
    if (k == walker.entry || !walker.may_leave[k]) continue;
    const Vec2 side = corner[(k + 1) % 3] - corner[k];
    const double closing = -cross(side, walker.heading);
    if (!(closing > 0)) continue;
    const double reach = std::max(0.0, cross(side, walker.at - corner[k]) / closing);
    if (reach < distance) {
      distance = reach;
      leave = k;
    }
  }
  return leave;
}

// From the edge `leave` of its face, which the walker stands on, over to the twin's face.
void InputSurface::enter(Index twin, Index leave, Walker& walker) const {
  const auto& corner = layout_[walker.face];
  const Vec2 side = corner[(leave + 1) % 3] - corner[leave];
  const double length = side.norm();
  const double share =
      std::clamp((walker.at - corner[leave]).dot(side) / (length * length), 0.0, 1.0);
  const Index g = HalfEdges::face(twin), k = twin % 3;
  const Vec2 &tip = layout_[g][k], &tail = layout_[g][(k + 1) % 3];
  const Vec2 from = side / length, to = (tip - tail) / length;
  const Vec2 turn(from.dot(to), cross(from, to));
  walker = {g, tail + share * (tip - tail), rotated(walker.heading, turn).normalized(), k};
}

InputSurface::Trace InputSurface::walk_on(Walker walker, double distance) const {
  // A geodesic crosses an edge only so often; the bound only stops walks on corrupt lengths.
  for (std::size_t step = 0; step < 3 * edges_.tail.size() + 64; ++step) {
    double ahead = distance;
    const Index leave = exit_of(walker, ahead);
    walker.at += walker.heading * ahead;
    distance -= ahead;
    const Index twin = leave == kNone ? kNone : edges_.twin[3 * walker.face + leave];
    if (twin == kNone) break;  // arrived, or rounding led to the boundary
    enter(twin, leave, walker);
  }
  return {{walker.face, planar_barycentric(layout_[walker.face], walker.at)}, walker.heading};
}

InputSurface::Trace InputSurface::trace(Index vertex, double direction, double distance) const {
  return walk_on(start(vertex, direction), distance);
}

InputSurface::Trace InputSurface::trace(const SurfacePoint& from, const Vec2& heading,
                                        double distance) const {
  const Vec2 at = interpolate(layout_[from.face], from.barycentric);
  return walk_on({from.face, at, heading}, distance);
}

}  // namespace onmesh
