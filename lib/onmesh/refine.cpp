#include "onmesh/refine.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <string>

#include "onmesh/edge_table.h"
#include "onmesh/error.h"
#include "onmesh/intrinsic.h"
#include "onmesh/refine_soup.h"

namespace onmesh {
namespace {

// A face is too large when its circumradius exceeds this share of the wanted spacing; it makes the
// number of nodes that of an equilateral lattice of that spacing (measured by bench_refine).
constexpr double kCircumradiusPerSpacing = 0.7;
// Boundary edges are split down to this share of the wanted spacing, no further; so small angles
// between boundary edges cannot make the refinement go on for ever.
constexpr double kShortestBoundaryEdge = 0.01;

// Thin faces whose circumradius is below this share of the wanted spacing stay: features of the
// input that are so much finer than the filter do not deserve nodes.
constexpr double kFinestCircumradius = 1e-3;
// A circumcentre whose barycentric coordinate is below this goes onto the edge.
constexpr double kOnEdge = 1e-3;

// Chew's second algorithm on an intrinsic triangulation: insert the circumcentre of the worst face,
// or split the boundary edge in its way, until all are good.
class Refiner {
 public:
  Refiner(IntrinsicTriangulation& triangulation, const RefineOptions& options)
      : t_(triangulation),
        options_(options),
        sine_(std::sin(options.min_angle_degrees * std::numbers::pi / 180)) {
    wanted_spacing();
  }

  void run(RefineReport& report) {
    report.flips = t_.flip_to_delaunay();
    for (Index f = 0; f < t_.edges().face_count(); ++f) push(f);
    while (!queue_.empty()) {
      const Entry entry = queue_.top();
      queue_.pop();
      if (!(badness(entry.face) == entry.badness)) continue;  // has changed since
      if (t_.node_count() >= options_.max_nodes) {
        throw InputError("the node spacing would need more than " +
                         std::to_string(options_.max_nodes) + " nodes");
      }
      report.flips += improve(entry.face);
      ++report.insertions;
    }
    report.smallest_angle_degrees = smallest_angle() * 180 / std::numbers::pi;
  }

 private:
  struct Entry {
    double badness;
    Index face;
    bool operator<(const Entry& other) const {
      return badness != other.badness ? badness < other.badness : face > other.face;
    }
  };

  // Spacing per input vertex: fine at cones, saddles and reflex corners, where distances bend most,
  // and growing with the distance from them.
  void wanted_spacing() {
    const double finest = options_.finest > 0 ? options_.finest : options_.spacing / 4;
    spacing_.assign(t_.node_count(), options_.spacing);
    using Reached = std::pair<double, Index>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    for (Index v = 0; v < t_.node_count(); ++v) {
      if (t_.outgoing(v) == kNone) continue;
      const double angle = t_.total_angle(v);
      const double bend = t_.on_boundary(v) ? std::max(0.0, angle - std::numbers::pi)
                                            : std::abs(2 * std::numbers::pi - angle);
      spacing_[v] = std::max(finest, options_.spacing / (1 + 2 * bend));
      if (spacing_[v] < options_.spacing) front.emplace(spacing_[v], v);
    }
    for (const Index v : options_.singular) {
      spacing_[v] = finest;
      front.emplace(finest, v);
    }
    const HalfEdges& e = t_.input();
    while (!front.empty()) {
      const auto [spacing, v] = front.top();
      front.pop();
      if (spacing > spacing_[v]) continue;
      const auto relax = [&, s = spacing](Index to, double length) {
        const double reached = s + options_.growth * length;
        if (reached < spacing_[to]) {
          spacing_[to] = reached;
          front.emplace(reached, to);
        }
      };
      Index h = t_.input_outgoing(v);
      do {
        relax(e.tip(h), e.length[h]);
        const Index back = HalfEdges::prev(h);
        relax(e.tail[back], e.length[back]);
        h = e.twin[back];
      } while (h != kNone && h != t_.input_outgoing(v));
    }
  }

  double circumradius(Index f) const {
    const HalfEdges& e = t_.edges();
    const double a = e.length[3 * f], b = e.length[3 * f + 1], c = e.length[3 * f + 2];
    return a * b * c / std::max(4 * e.area(f), 1e-300);
  }

  // A small angle that no refinement can remove: the node at it has no room for a larger one, or
  // its opposite side is a boundary edge that must not become shorter.
  bool forced(Index f) const {
    const HalfEdges& e = t_.edges();
    Index shortest = 3 * f;
    for (const Index h : {3 * f + 1, 3 * f + 2}) {
      if (e.length[h] < e.length[shortest]) shortest = h;
    }
    return is_needle(e.tail[HalfEdges::prev(shortest)]);
  }

  bool is_needle(Index node) const {
    return node < t_.input_vertex_count() && t_.total_angle(node) < std::numbers::pi / 3 + 1e-9;
  }

  bool too_large(Index f, double circumradius) const {
    const HalfEdges& e = t_.edges();
    const double sum =
        spacing_[e.tail[3 * f]] + spacing_[e.tail[3 * f + 1]] + spacing_[e.tail[3 * f + 2]];
    return circumradius > kCircumradiusPerSpacing * sum / 3;
  }

  // The circumradius if the face is too large or too thin, else 0.
  double badness(Index f) const {
    const HalfEdges& e = t_.edges();
    const double r = circumradius(f);
    if (too_large(f, r)) return r;
    if (r < kFinestCircumradius * spacing_[e.tail[3 * f]]) return 0;
    const double shortest = std::min({e.length[3 * f], e.length[3 * f + 1], e.length[3 * f + 2]});
    return shortest < 2 * r * sine_ && !forced(f) ? r : 0;
  }

  void push(Index f) {
    const double b = badness(f);
    if (b > 0) queue_.push({b, f});
  }

  // Walk from the face's centroid to its circumcentre over the intrinsic faces. Returns the face
  // that holds it with barycentric coordinates, or the boundary half-edge in between.
  struct Destination {
    NodePoint point;
    Index blocked_by = kNone;
  };
  Destination walk_to_circumcentre(Index f) const {
    const HalfEdges& e = t_.edges();
    std::array<Vec2, 3> at = e.layout(f);
    const double x = 0.5 * at[1].x();
    const Vec2 c = at[2];
    const Vec2 goal(x, (c.squaredNorm() - 2 * x * c.x()) / (2 * std::max(c.y(), 1e-300)));
    const Vec2 from = (at[0] + at[1] + at[2]) / 3, way = goal - from;
    Index entry = kNone;
    for (int step = 0; step < 100000; ++step) {
      double nearest = 1;
      Index leave = kNone;
      for (Index k = 0; k < 3; ++k) {
        if (k == entry) continue;
        const Vec2 side = at[(k + 1) % 3] - at[k], to = from - at[k];
        const double closing = -(side.x() * way.y() - side.y() * way.x());
        if (!(closing > 0)) continue;
        const double reach = (side.x() * to.y() - side.y() * to.x()) / closing;
        if (reach < nearest) {
          nearest = reach;
          leave = k;
        }
      }
      if (leave == kNone) break;
      const Index twin = e.twin[3 * f + leave];
      if (twin == kNone) return {{}, 3 * f + leave};
      const Vec2 a = at[leave], b = at[(leave + 1) % 3];
      f = HalfEdges::face(twin);
      entry = twin % 3;
      at[entry] = b;
      at[(entry + 1) % 3] = a;
      at[(entry + 2) % 3] = e.opposite(twin, b, a);
    }
    return {{f, planar_barycentric(at, goal)}, kNone};
  }

  // The half-edge of the face on the boundary whose diametral circle holds the point.
  Index encroached(const NodePoint& p) const {
    const HalfEdges& e = t_.edges();
    const std::array<Vec2, 3> at = e.layout(p.face);
    const Vec2 x = at[0] * p.barycentric[0] + at[1] * p.barycentric[1] + at[2] * p.barycentric[2];
    for (Index k = 0; k < 3; ++k) {
      if (e.twin[3 * p.face + k] == kNone && (at[k] - x).dot(at[(k + 1) % 3] - x) < 0)
        return 3 * p.face + k;
    }
    return kNone;
  }

  // Towards a needle, angles can be improved for ever, ever closer to its tip.
  bool at_needle(const Destination& to) const {
    const Index f = to.blocked_by == kNone ? to.point.face : HalfEdges::face(to.blocked_by);
    const HalfEdges& e = t_.edges();
    return is_needle(e.tail[3 * f]) || is_needle(e.tail[3 * f + 1]) || is_needle(e.tail[3 * f + 2]);
  }

  Index improve(Index f) {
    Destination to = walk_to_circumcentre(f);
    if (to.blocked_by == kNone) to.blocked_by = encroached(to.point);
    touched_.clear();
    touched_.push_back(f);
    if (!too_large(f, circumradius(f)) && at_needle(to)) return 0;
    std::vector<Index> suspects;
    const HalfEdges& e = t_.edges();
    if (to.blocked_by != kNone) {
      const Index h = to.blocked_by, a = e.tail[h], b = e.tip(h);
      const double half = 0.5 * e.length[h], spacing = std::min(spacing_[a], spacing_[b]);
      if (2 * half < kShortestBoundaryEdge * spacing) return 0;
      split(h, 0.5, std::min(options_.spacing, spacing + options_.growth * half), suspects);
    } else {
      const Index g = to.point.face, appended = e.face_count();
      Vec3 b = to.point.barycentric;
      const std::array<Vec2, 3> at = e.layout(g);
      const Vec2 x = at[0] * b[0] + at[1] * b[1] + at[2] * b[2];
      double spacing = options_.spacing;
      for (Index k = 0; k < 3; ++k) {
        spacing =
            std::min(spacing, spacing_[e.tail[3 * g + k]] + options_.growth * (x - at[k]).norm());
      }
      // Close to an edge, onto it: a flat triangle's lengths would not tell its height.
      Index least = 0;
      b.minCoeff(&least);
      const Index h = 3 * g + (least + 1) % 3;
      if (b[least] < kOnEdge && split(h, b[(least + 2) % 3] / (1 - b[least]), spacing, suspects)) {
        return finish(std::move(suspects));
      }
      b = b.cwiseMax(kOnEdge);
      b /= b.sum();
      t_.insert(g, b);
      spacing_.push_back(spacing);
      touched_.insert(touched_.end(), {g, appended, appended + 1});
      suspects = {3 * g, 3 * appended, 3 * (appended + 1)};
    }
    return finish(std::move(suspects));
  }

  // Split an edge; false if both its sides are one face.
  bool split(Index h, double share, double spacing, std::vector<Index>& suspects) {
    const HalfEdges& e = t_.edges();
    const Index twin = e.twin[h], appended = e.face_count();
    if (t_.split(h, share) == kNone) return false;
    spacing_.push_back(spacing);
    touched_.insert(touched_.end(), {HalfEdges::face(h), appended});
    suspects = {HalfEdges::prev(h), 3 * appended + 1};
    if (twin != kNone) {
      touched_.insert(touched_.end(), {HalfEdges::face(twin), appended + 1});
      suspects.insert(suspects.end(), {HalfEdges::prev(twin), 3 * appended + 4});
    }
    return true;
  }

  Index finish(std::vector<Index> suspects) {
    const Index flips = t_.flip_to_delaunay(std::move(suspects), &touched_);
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (const Index g : touched_) push(g);
    return flips;
  }

  double smallest_angle() const {
    double least = std::numbers::pi;
    for (Index h = 0; h < t_.edges().tail.size(); ++h) {
      if (!forced(HalfEdges::face(h))) least = std::min(least, t_.edges().corner_angle(h));
    }
    return least;
  }

  IntrinsicTriangulation& t_;
  RefineOptions options_;
  double sine_;
  std::vector<double> spacing_;  // per node
  std::priority_queue<Entry> queue_;
  std::vector<Index> touched_;
};

}  // namespace

NodeSurface refine(const TriangleMesh& mesh, const HalfEdgeMesh& half_edges,
                   const RefineOptions& options, RefineReport* report) {
  if (!(options.spacing > 0) || !std::isfinite(options.spacing)) {
    throw UsageError("the node spacing must be positive and finite");
  }
  IntrinsicTriangulation triangulation(mesh, half_edges);
  RefineReport local;
  local.input_vertices = triangulation.input_vertex_count();
  Refiner(triangulation, options).run(local);
  NodeSurface surface{triangulation.node_mesh(), make_overlay(triangulation)};
  local.nodes = static_cast<Index>(surface.nodes.nodes.size());
  local.faces = static_cast<Index>(surface.nodes.faces.size());
  if (report != nullptr) *report = local;
  return surface;
}

namespace {

/// Refine a mesh that is manifold but for vertices with several fans of faces: with a vertex for
/// each fan, which become one node again.
NodeSurface refine_fans_apart(const TriangleMesh& mesh, RefineOptions options,
                              RefineReport* report) {
  const Index vertices = Index(mesh.positions.size());
  DisjointSets fans = join_fans(mesh, EdgeTable(mesh));
  TriangleMesh apart = mesh;
  std::vector<Index> vertex_of_fan(3 * mesh.faces.size(), kNone), original;
  std::vector<bool> is_taken(vertices, false);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      Index& own = vertex_of_fan[fans.find(3 * f + k)];
      if (own == kNone && !is_taken[v]) {
        is_taken[v] = true;
        own = v;
      } else if (own == kNone) {
        own = Index(apart.positions.size());
        apart.positions.push_back(mesh.positions[v]);
        original.push_back(v);
      }
      apart.faces[f][k] = own;
    }
  }
  for (Index i = 0; i < original.size(); ++i) {
    options.singular.push_back(original[i]);
    options.singular.push_back(vertices + i);
  }
  NodeSurface surface = refine(apart, make_half_edge_mesh(apart), options, report);

  NodeMesh& nodes = surface.nodes;
  const Index added = Index(original.size());
  nodes.nodes.erase(nodes.nodes.begin() + vertices, nodes.nodes.begin() + vertices + added);
  for (auto& face : nodes.faces) {
    for (Index& n : face) {
      if (n >= vertices) n = n < vertices + added ? original[n - vertices] : n - added;
    }
  }
  nodes.build_incidence();
  if (report != nullptr) {
    report->input_vertices = vertices;
    report->nodes -= added;
  }
  return surface;
}

}  // namespace

NodeSurface refine(const TriangleMesh& mesh, const CleanReport& cleaning,
                   const RefineOptions& options, RefineReport* report) {
  if (options.flat_faces || !cleaning.manifold_apart()) return refine_soup(mesh, options, report);
  if (cleaning.bow_ties > 0) return refine_fans_apart(mesh, options, report);
  return refine(mesh, make_half_edge_mesh(mesh), options, report);
}

}  // namespace onmesh
