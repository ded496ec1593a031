#include "onmesh/nodes/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

}  // namespace

IntrinsicTriangulation::IntrinsicTriangulation(HalfEdges input, Index vertices)
    : input_(std::move(input), vertices), edges_(input_.edges()) {
  direction_.resize(edges_.tail.size());
  for (Index h = 0; h < direction_.size(); ++h) direction_[h] = input_.direction(h);
  for (Index v = 0; v < vertices; ++v) {
    const Index h = input_.outgoing(v);
    outgoing_.push_back(h);
    total_angle_.push_back(input_.total_angle(v));
    boundary_.push_back(input_.on_boundary(v) ? 1 : 0);
    locations_.emplace_back();
    if (h != kNone) locations_.back() = {HalfEdges::face(h), Vec3::Unit(h % 3)};
  }
}

bool IntrinsicTriangulation::flip(Index h) {
  const Index t = edges_.twin[h];
  if (t == kNone) return false;
  const std::array<Index, 4> old = edges_.around(h);
  const std::array<Index, 4> tails{edges_.tail[h], edges_.tail[t], edges_.tail[old[1]],
                                   edges_.tail[old[3]]};
  if (!edges_.flip(h)) return false;
  std::array<double, 4> direction;
  for (std::size_t i = 0; i < 4; ++i) direction[i] = direction_[old[i]];
  for (std::size_t i = 0; i < 4; ++i) direction_[old[(i + 3) % 4]] = direction[i];

  // Old numbers mean other half-edges now; repeated vertices must be renamed only once.
  std::array<Index, 4> leaving;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index e = outgoing_[tails[i]];
    const auto moved = std::find(old.begin(), old.end(), e);
    // h left a, t left b; what leaves them next took the places of c->a and d->b.
    leaving[i] = e == h               ? old[1]
                 : e == t             ? old[3]
                 : moved == old.end() ? e
                                      : old[(moved - old.begin() + 3) % 4];
  }
  for (std::size_t i = 0; i < 4; ++i) outgoing_[tails[i]] = leaving[i];

  const Index ca = old[0], db = old[2];
  set_direction(t, direction_[ca] + edges_.corner_angle(ca));
  set_direction(h, direction_[db] + edges_.corner_angle(db));
  return true;
}

void IntrinsicTriangulation::set_direction(Index h, double angle) {
  const Index v = edges_.tail[h];
  if (boundary_[v] == 0) {
    const double total = total_angle_[v];
    if (angle >= total) angle -= total;
    if (angle < 0) angle += total;
  }
  direction_[h] = angle;
}

Index IntrinsicTriangulation::flip_to_delaunay() {
  std::vector<Index> all(edges_.tail.size());
  for (Index h = 0; h < all.size(); ++h) all[h] = h;
  return edges_.flip_to_delaunay(std::move(all), [this](Index h) { return flip(h); });
}

Index IntrinsicTriangulation::restore_delaunay(Index node) {
  suspects_.clear();
  Index spoke = outgoing_[node];
  do {
    suspects_.push_back(HalfEdges::next(spoke));
    spoke = edges_.rotate(spoke);
  } while (spoke != kNone && spoke != outgoing_[node]);
  Index flips = 0;
  const std::size_t bound = 1000 + 100 * edges_.tail.size();  // see HalfEdges::flip_to_delaunay()
  while (!suspects_.empty() && flips < bound) {
    const Index h = suspects_.back();
    suspects_.pop_back();
    if (is_delaunay(h)) continue;
    const Index twin = edges_.twin[h];
    const bool on_both_sides = edges_.tail[HalfEdges::prev(twin)] == node;
    if (!flip(h)) continue;
    ++flips;
    // The edges at the node are Delaunay; those across the edge that went are not known to be.
    suspects_.insert(suspects_.end(), {HalfEdges::prev(h), HalfEdges::next(twin)});
    if (on_both_sides) {
      suspects_.insert(suspects_.end(), {HalfEdges::next(h), HalfEdges::prev(twin)});
    }
  }
  return flips;
}

Index IntrinsicTriangulation::append_faces(Index count) {
  const Index first = edges_.face_count();
  const std::size_t size = std::size_t{3} * (first + count);
  edges_.tail.resize(size, kNone);
  edges_.twin.resize(size, kNone);
  edges_.length.resize(size, 0);
  direction_.resize(size, 0);
  return first;
}

void IntrinsicTriangulation::append_node(Index outgoing, bool on_boundary,
                                         const SurfacePoint& location) {
  outgoing_.push_back(outgoing);
  boundary_.push_back(on_boundary ? 1 : 0);
  total_angle_.push_back(on_boundary ? std::numbers::pi : kTwoPi);
  locations_.push_back(location);
}

void IntrinsicTriangulation::move_half_edge(Index from, Index to) {
  edges_.tail[to] = edges_.tail[from];
  edges_.length[to] = edges_.length[from];
  direction_[to] = direction_[from];
  edges_.twin[to] = edges_.twin[from];
  if (edges_.twin[from] != kNone) edges_.twin[edges_.twin[from]] = to;
  if (outgoing_[edges_.tail[to]] == from) outgoing_[edges_.tail[to]] = to;
}

void IntrinsicTriangulation::set_edge(Index h, Index twin, Index tail, Index tip, double length) {
  edges_.tail[h] = tail;
  edges_.tail[twin] = tip;
  edges_.twin[h] = twin;
  edges_.twin[twin] = h;
  edges_.length[h] = edges_.length[twin] = length;
}

InputSurface::Trace IntrinsicTriangulation::trace(Index node, double direction,
                                                  double distance) const {
  if (is_input(node)) return input_.trace(node, direction, distance);
  return input_.trace(locations_[node], {std::cos(direction), std::sin(direction)}, distance);
}

IntrinsicTriangulation::Walk IntrinsicTriangulation::walk_to(Index f,
                                                             const Vec3& barycentric) const {
  const std::array<Vec2, 3> corner = edges_.layout(f);
  const Vec2 at = interpolate(corner, barycentric);
  Walk walk;
  for (std::size_t k = 0; k < 3; ++k) walk.distance[k] = (at - corner[k]).norm();
  walk.corner = static_cast<Index>(std::min_element(walk.distance.begin(), walk.distance.end()) -
                                   walk.distance.begin());
  const Vec2 along = corner[(walk.corner + 1) % 3] - corner[walk.corner],
             to = at - corner[walk.corner];
  const double turn = std::atan2(cross(along, to), along.dot(to));
  const Index h = 3 * f + walk.corner;
  walk.end = trace(edges_.tail[h], direction_[h] + turn, walk.distance[walk.corner]);
  return walk;
}

SurfacePoint IntrinsicTriangulation::on_input(const NodePoint& point) const {
  return walk_to(point.face, point.barycentric).end.point;
}

void IntrinsicTriangulation::turn_around(std::span<const Index> spokes, std::size_t first,
                                         const Vec2& arrival) {
  double angle = std::atan2(-arrival.y(), -arrival.x());
  if (angle < 0) angle += kTwoPi;
  for (std::size_t k = 0; k < spokes.size(); ++k) {
    const Index spoke = spokes[(first + k) % spokes.size()];
    set_direction(spoke, angle);
    angle = direction_[spoke] + edges_.corner_angle(spoke);
  }
}

Index IntrinsicTriangulation::insert(Index f, const Vec3& barycentric) {
  const Walk walk = walk_to(f, barycentric);
  const auto& distance = walk.distance;

  // Faces (a, b, v) in f's place, (b, c, v) and (c, a, v) appended.
  const Index ab = 3 * f, bc = ab + 1, ca = ab + 2;
  const Index a = edges_.tail[ab], b = edges_.tail[bc], c = edges_.tail[ca];
  const Index first = append_faces(2);
  const Index new_bc = 3 * first, new_ca = new_bc + 3;
  const auto v = static_cast<Index>(outgoing_.size());
  move_half_edge(bc, new_bc);
  move_half_edge(ca, new_ca);
  set_edge(ab + 1, new_bc + 2, b, v, distance[1]);
  set_edge(new_bc + 1, new_ca + 2, c, v, distance[2]);
  set_edge(new_ca + 1, ab + 2, a, v, distance[0]);
  append_node(ab + 2, false, walk.end.point);

  set_direction(new_ca + 1, direction_[ab] + edges_.corner_angle(ab));
  set_direction(ab + 1, direction_[new_bc] + edges_.corner_angle(new_bc));
  set_direction(new_bc + 1, direction_[new_ca] + edges_.corner_angle(new_ca));
  // Around v, counter-clockwise: v->a, v->b, v->c; one of them points back along the walk.
  const std::array<Index, 3> spokes{ab + 2, new_bc + 2, new_ca + 2};
  turn_around(spokes, walk.corner, walk.end.heading);
  return v;
}

// Boundary edges never flip, so that from a to b lies along one input edge: where on it.
SurfacePoint IntrinsicTriangulation::place_on_boundary(Index edge, Index a, Index b,
                                                       double share) const {
  const Index k = edge % 3, k1 = (k + 1) % 3;
  const double from = is_input(a) ? 0 : locations_[a].barycentric[k1];
  const double to = is_input(b) ? 1 : locations_[b].barycentric[k1];
  SurfacePoint location{HalfEdges::face(edge), Vec3::Zero()};
  location.barycentric[k1] = from + share * (to - from);
  location.barycentric[k] = 1 - location.barycentric[k1];
  return location;
}

Index IntrinsicTriangulation::split(Index h, double share) {
  const Index t = edges_.twin[h];
  if (t != kNone && HalfEdges::face(t) == HalfEdges::face(h)) return kNone;
  const Index a = edges_.tail[h], b = edges_.tip(h);
  const Index bc = HalfEdges::next(h), ca = HalfEdges::prev(h), c = edges_.tail[ca];
  const double length = edges_.length[h], to_a = share * length, to_b = length - to_a;
  const double to_c = edges_.opposite(h, Vec2(-to_a, 0), Vec2(to_b, 0)).norm();
  Vec3 barycentric = Vec3::Zero();
  barycentric[h % 3] = 1 - share;
  barycentric[bc % 3] = share;
  const Walk walk = walk_to(HalfEdges::face(h), barycentric);
  double to_d = 0;
  if (t != kNone) to_d = edges_.opposite(t, Vec2(to_b, 0), Vec2(-to_a, 0)).norm();

  // Faces (a, m, c) in place and (m, b, c) appended; on the other side (b, m, d) and (m, a, d).
  const auto m = static_cast<Index>(outgoing_.size());
  const Index mb = 3 * append_faces(t == kNone ? 1 : 2), ma = mb + 3;
  append_node(mb, t == kNone, walk.end.point);
  move_half_edge(bc, mb + 1);
  set_edge(bc, mb + 2, m, c, to_c);
  edges_.tail[mb] = m;
  edges_.length[h] = to_a;
  edges_.length[mb] = to_b;
  edges_.twin[mb] = kNone;
  if (t == kNone) {
    const Index edge = is_input(a) ? input_.outgoing(a) : boundary_edge_[a - input_.vertex_count()];
    locations_.back() = place_on_boundary(edge, a, b, share);
    boundary_edge_.resize(outgoing_.size() - input_.vertex_count(), kNone);
    boundary_edge_.back() = edge;
    const auto& corner = input_.layout(HalfEdges::face(edge));
    const Vec2 along = corner[(edge % 3 + 1) % 3] - corner[edge % 3];
    set_direction(mb, std::atan2(along.y(), along.x()));
    set_direction(bc, direction_[mb] + edges_.corner_angle(mb));
  } else {
    const Index ad = HalfEdges::next(t), db = HalfEdges::prev(t), d = edges_.tail[db];
    move_half_edge(ad, ma + 1);
    set_edge(ad, ma + 2, m, d, to_d);
    set_edge(h, ma, a, m, to_a);
    set_edge(t, mb, b, m, to_b);
    set_direction(ad, 0);
    set_direction(ma + 2, direction_[db] + edges_.corner_angle(db));
    // Around m, counter-clockwise: to a, d, b, c. The walk came from a, b or c.
    const std::array<Index, 4> spokes{ma, ad, mb, bc};
    const std::array<std::size_t, 3> came_from{0, 2, 3};
    turn_around(spokes, came_from[(walk.corner + 3 - h % 3) % 3], walk.end.heading);
  }
  set_direction(mb + 2, direction_[ca] + edges_.corner_angle(ca));
  return m;
}

NodeMesh IntrinsicTriangulation::node_mesh() const {
  NodeMesh out;
  out.nodes = locations_;
  const Index faces = edges_.face_count();
  out.faces.resize(faces);
  out.lengths.resize(faces);
  out.neighbours.resize(faces);
  for (Index f = 0; f < faces; ++f) {
    for (Index k = 0; k < 3; ++k) {
      out.faces[f][k] = edges_.tail[3 * f + k];
      out.lengths[f][k] = edges_.length[3 * f + k];
      out.neighbours[f][k] = edges_.twin[3 * f + k];
    }
  }
  out.build_incidence();
  return out;
}

}  // namespace onmesh
