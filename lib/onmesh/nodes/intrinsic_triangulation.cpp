#include "onmesh/nodes/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onmesh/base/error.h"
#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"

namespace onmesh {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

Vec2 rotated(const Vec2& v, const Vec2& by) {
  return {v.x() * by.x() - v.y() * by.y(), v.x() * by.y() + v.y() * by.x()};
}

// Connectivity from OpenMesh with half-edges in the order of the faces' corners.
HalfEdges flat_half_edges(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges) {
  const std::size_t count = mesh.faces.size() * 3;
  HalfEdges out{std::vector<Index>(count), std::vector<Index>(count, kNone),
                std::vector<double>(count)};
  std::vector<Index> flat(half_edges.n_halfedges(), kNone);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    auto h = half_edges.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(f)));
    while (half_edges.from_vertex_handle(h).idx() != static_cast<int>(mesh.faces[f][0])) {
      h = half_edges.next_halfedge_handle(h);
    }
    for (Index k = 0; k < 3; ++k, h = half_edges.next_halfedge_handle(h)) {
      const Index e = 3 * f + k;
      flat[static_cast<std::size_t>(h.idx())] = e;
      out.tail[e] = mesh.faces[f][k];
      out.length[e] =
          (mesh.positions[mesh.faces[f][(k + 1) % 3]] - mesh.positions[mesh.faces[f][k]]).norm();
    }
  }
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (flat[i] == kNone) continue;
    const auto opposite =
        half_edges.opposite_halfedge_handle(OpenMesh::HalfedgeHandle(static_cast<int>(i)));
    out.twin[flat[i]] = flat[static_cast<std::size_t>(opposite.idx())];
    // Both sides must carry the same bits.
    if (out.twin[flat[i]] != kNone) out.length[out.twin[flat[i]]] = out.length[flat[i]];
  }
  return out;
}

// Lengthen every edge so that the triangle inequality holds with a little to spare.
void mollify(HalfEdges& edges) {
  double sum = 0;
  for (const double l : edges.length) sum += l;
  const double slack =
      1e-12 * sum / static_cast<double>(std::max<std::size_t>(1, edges.length.size()));
  double add = 0;
  for (Index h = 0; h < edges.length.size(); ++h) {
    const double l = edges.length[h];
    const double others = edges.length[HalfEdges::next(h)] + edges.length[HalfEdges::prev(h)];
    add = std::max(add, slack - (others - l));
  }
  if (add > 0) {
    for (double& l : edges.length) l += add;
  }
}

}  // namespace

double HalfEdges::area(Index f) const {
  return triangle_area(length[3 * f], length[3 * f + 1], length[3 * f + 2]);
}

double HalfEdges::corner_angle(Index h) const {
  const double a = length[h], b = length[prev(h)], c = length[next(h)];
  // The dot product a b cos = (a^2 + b^2 - c^2) / 2, arranged against cancellation.
  const double dot = 0.5 * (b * b + (a - c) * (a + c));
  return std::atan2(2 * area(face(h)), dot);
}

std::array<Vec2, 3> HalfEdges::layout(Index f) const {
  const Vec2 a = Vec2::Zero(), b(length[3 * f], 0);
  return {a, b, opposite(3 * f, a, b)};
}

Vec2 HalfEdges::opposite(Index h, const Vec2& a, const Vec2& b) const {
  const double l = length[h], to_a = length[prev(h)], to_b = length[next(h)];
  const double along = 0.5 * ((to_a - to_b) * (to_a + to_b) / l + l);
  const double height = 2 * area(face(h)) / l;
  const Vec2 x = (b - a) / l;
  return a + along * x + height * Vec2(-x.y(), x.x());
}

double HalfEdges::cotan_sum(Index h) const {
  const auto cotan = [this](Index e) {
    const double a = length[e], b = length[next(e)], c = length[prev(e)];
    // Degenerate faces give a large finite value of the right sign.
    return ((b - a) * (b + a) + c * c) / (4 * std::max(area(face(e)), 1e-150 * (b * b + c * c)));
  };
  return cotan(h) + cotan(twin[h]);
}

IntrinsicTriangulation::IntrinsicTriangulation(const TriangleMesh& mesh,
                                               const HalfEdgeMesh& half_edges)
    : IntrinsicTriangulation(flat_half_edges(mesh, half_edges), Index(mesh.positions.size())) {}

IntrinsicTriangulation::IntrinsicTriangulation(HalfEdges input, Index vertices)
    : input_vertices_(vertices), input_(std::move(input)) {
  mollify(input_);
  edges_ = input_;
  outgoing_.assign(vertices, kNone);
  boundary_.assign(vertices, 0);
  total_angle_.assign(vertices, 0);
  locations_.resize(vertices);
  for (Index h = 0; h < input_.tail.size(); ++h) {
    const Index v = input_.tail[h];
    const bool clockwise_most = input_.twin[h] == kNone;
    if (outgoing_[v] == kNone || clockwise_most) outgoing_[v] = h;
    if (clockwise_most) boundary_[v] = boundary_[input_.tip(h)] = 1;
  }
  input_outgoing_ = outgoing_;

  direction_.assign(input_.tail.size(), 0);
  for (Index v = 0; v < vertices; ++v) {
    if (outgoing_[v] == kNone) continue;  // isolated
    Index h = outgoing_[v];
    double angle = 0;
    do {
      direction_[h] = angle;
      angle += input_.corner_angle(h);
      h = input_.rotate(h);
    } while (h != kNone && h != outgoing_[v]);
    total_angle_[v] = angle;
    locations_[v].face = HalfEdges::face(outgoing_[v]);
    locations_[v].barycentric = Vec3::Unit(outgoing_[v] % 3);
  }
  input_direction_ = direction_;

  input_layout_.resize(input_.face_count());
  for (Index f = 0; f < input_layout_.size(); ++f) input_layout_[f] = input_.layout(f);
}

bool HalfEdges::is_delaunay(Index h) const {
  // The tolerance keeps cocircular quadrilaterals from being flipped for ever.
  return twin[h] == kNone || cotan_sum(h) >= -1e-9;
}

bool HalfEdges::flip(Index h) {
  const Index t = twin[h];
  if (t == kNone || face(h) == face(t)) return false;
  // Faces (a, b, c) on the left of h and (b, a, d) on its right; counter-clockwise a, d, b, c.
  const std::array<Index, 4> old = around(h);  // bc, ca, ad, db
  const Index c = tail[old[1]], d = tail[old[3]];
  const Vec2 at_a(0, 0), at_b(length[h], 0);
  const Vec2 at_c = opposite(h, at_a, at_b), at_d = opposite(t, at_b, at_a);
  if (!(cross(at_d - at_a, at_c - at_a) > 0) || !(cross(at_c - at_b, at_d - at_b) > 0))
    return false;
  const double diagonal = (at_d - at_c).norm();
  if (!(diagonal > 0)) return false;

  struct Side {
    Index twin, tail;
    double length;
  };
  std::array<Side, 4> side;
  for (std::size_t i = 0; i < 4; ++i) side[i] = {twin[old[i]], tail[old[i]], length[old[i]]};
  // New faces: (d, c, a) in h's place with h = d->c, and (c, d, b) in t's place with t = c->d.
  for (std::size_t i = 0; i < 4; ++i) {
    const Index e = old[(i + 3) % 4];
    tail[e] = side[i].tail;
    length[e] = side[i].length;
    const auto inside = std::find(old.begin(), old.end(), side[i].twin);
    twin[e] = inside == old.end() ? side[i].twin : old[(inside - old.begin() + 3) % 4];
    // An outside twin learns the new number; twins among the four are set by their own turn.
    if (twin[e] != kNone) twin[twin[e]] = e;
  }
  tail[h] = d;
  tail[t] = c;
  length[h] = length[t] = diagonal;
  return true;
}

Index HalfEdges::flip_to_delaunay(std::vector<Index> suspects,
                                  const std::function<bool(Index)>& flip_edge) {
  Index flips = 0;
  // Lawson's algorithm ends after finitely many flips; in floating point a bound makes sure of it.
  const std::size_t bound = 1000 + 100 * tail.size();
  while (!suspects.empty() && flips < bound) {
    const Index h = suspects.back();
    suspects.pop_back();
    if (is_delaunay(h) || !flip_edge(h)) continue;
    ++flips;
    for (const Index e : around(h)) suspects.push_back(e);
  }
  return flips;
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

IntrinsicTriangulation::Walk IntrinsicTriangulation::walk_to(Index f,
                                                             const Vec3& barycentric) const {
  const std::array<Vec2, 3> corner = edges_.layout(f);
  const Vec2 at =
      corner[0] * barycentric[0] + corner[1] * barycentric[1] + corner[2] * barycentric[2];
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
  outgoing_.push_back(ab + 2);
  boundary_.push_back(0);
  total_angle_.push_back(kTwoPi);
  locations_.push_back(walk.end.point);

  set_direction(new_ca + 1, direction_[ab] + edges_.corner_angle(ab));
  set_direction(ab + 1, direction_[new_bc] + edges_.corner_angle(new_bc));
  set_direction(new_bc + 1, direction_[new_ca] + edges_.corner_angle(new_ca));
  // Around v, counter-clockwise: v->a, v->b, v->c; one of them points back along the walk.
  const std::array<Index, 3> spokes{ab + 2, new_bc + 2, new_ca + 2};
  turn_around(spokes, walk.corner, walk.end.direction);
  return v;
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
  outgoing_.push_back(mb);
  boundary_.push_back(t == kNone ? 1 : 0);
  total_angle_.push_back(t == kNone ? std::numbers::pi : kTwoPi);
  locations_.push_back(walk.end.point);
  move_half_edge(bc, mb + 1);
  set_edge(bc, mb + 2, m, c, to_c);
  edges_.tail[mb] = m;
  edges_.length[h] = to_a;
  edges_.length[mb] = to_b;
  edges_.twin[mb] = kNone;
  if (t == kNone) {
    // Boundary edges never flip, so h lies along one input edge.
    const Index edge =
        a < input_vertices_ ? input_outgoing_[a] : boundary_edge_[a - input_vertices_];
    const Index f = HalfEdges::face(edge), k = edge % 3, k1 = (k + 1) % 3;
    const double from = a < input_vertices_ ? 0 : locations_[a].barycentric[k1];
    const double to = b < input_vertices_ ? 1 : locations_[b].barycentric[k1];
    SurfacePoint& location = locations_.back();
    location = {f, Vec3::Zero()};
    location.barycentric[k1] = from + share * (to - from);
    location.barycentric[k] = 1 - location.barycentric[k1];
    boundary_edge_.resize(outgoing_.size() - input_vertices_, kNone);
    boundary_edge_.back() = edge;
    const Vec2 along = input_layout_[f][k1] - input_layout_[f][k];
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
    turn_around(spokes, came_from[(walk.corner + 3 - h % 3) % 3], walk.end.direction);
  }
  set_direction(mb + 2, direction_[ca] + edges_.corner_angle(ca));
  return m;
}

IntrinsicTriangulation::Trace IntrinsicTriangulation::trace(Index node, double direction,
                                                            double distance) const {
  Index f, entry = kNone;  // entry: the edge (0 to 2) the walk came in by, never left by
  Vec2 at, heading;
  std::array<bool, 3> may_leave{true, true, true};
  if (node < input_vertices_) {
    if (boundary_[node] == 0 && direction >= total_angle_[node]) direction -= total_angle_[node];
    Index h = input_outgoing_[node];
    const Index first = h;
    for (Index next = input_.rotate(h);
         next != kNone && next != first && input_direction_[next] <= direction;
         next = input_.rotate(h)) {
      h = next;
    }
    f = HalfEdges::face(h);
    const Index k = h % 3;
    at = input_layout_[f][k];
    const double turn = direction - input_direction_[h];
    heading = rotated((input_layout_[f][(k + 1) % 3] - at).normalized(),
                      {std::cos(turn), std::sin(turn)});
    may_leave = {k == 2, k == 0, k == 1};  // only by the edge opposite the corner
  } else {
    const SurfacePoint& p = locations_[node];
    f = p.face;
    at = input_layout_[f][0] * p.barycentric[0] + input_layout_[f][1] * p.barycentric[1] +
         input_layout_[f][2] * p.barycentric[2];
    heading = {std::cos(direction), std::sin(direction)};
  }

  // A geodesic crosses an edge only so often; the bound only stops walks on corrupt lengths.
  for (std::size_t step = 0; step < 3 * input_.tail.size() + 64; ++step) {
    const auto& corner = input_layout_[f];
    double nearest = distance;
    Index leave = kNone;
    for (Index k = 0; k < 3; ++k) {
      if (k == entry || !may_leave[k]) continue;
      const Vec2 side = corner[(k + 1) % 3] - corner[k];
      const double closing = -cross(side, heading);
      if (!(closing > 0)) continue;
      const double reach = std::max(0.0, cross(side, at - corner[k]) / closing);
      if (reach < nearest) {
        nearest = reach;
        leave = k;
      }
    }
    const Index twin = leave == kNone ? kNone : input_.twin[3 * f + leave];
    at += heading * nearest;
    distance -= nearest;
    if (twin == kNone) break;  // arrived, or rounding led to the boundary

    const Vec2 side = corner[(leave + 1) % 3] - corner[leave];
    const double length = side.norm();
    const double share = std::clamp((at - corner[leave]).dot(side) / (length * length), 0.0, 1.0);
    const Index g = HalfEdges::face(twin), k = twin % 3;
    const Vec2 &tip = input_layout_[g][k], &tail = input_layout_[g][(k + 1) % 3];
    const Vec2 from = side / length, to = (tip - tail) / length;
    const Vec2 turn(from.dot(to), cross(from, to));
    heading = rotated(heading, turn).normalized();
    at = tail + share * (tip - tail);
    f = g;
    entry = k;
    may_leave = {true, true, true};
  }
  return {{f, planar_barycentric(input_layout_[f], at)}, heading};
}

Vec3 planar_barycentric(const std::array<Vec2, 3>& corners, const Vec2& p) {
  Vec3 b(cross(corners[1] - p, corners[2] - p), cross(corners[2] - p, corners[0] - p),
         cross(corners[0] - p, corners[1] - p));
  b = b.cwiseMax(0.0);
  const double sum = b.sum();
  return sum > 0 ? Vec3(b / sum) : Vec3::Constant(1.0 / 3);
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
