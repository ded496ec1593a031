#include "onmesh/nodes/delaunay_refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "onmesh/base/plane.h"
#include "onmesh/base/triangle.h"
#include "onmesh/nodes/bad_faces.h"
#include "onmesh/nodes/sizing_field.h"
#include "onmesh/nodes/too_many_nodes.h"

namespace onmesh {
namespace {

// A face is too large when its circumradius exceeds this share of the wanted spacing.
constexpr double kCircumradiusPerSpacing = 0.7;
// Circumradius of the faces that the front makes, as a share of the largest one allowed: it leaves
// room for the irregular ones where fronts meet.
constexpr double kFrontRadius = 0.95;
// A face is at the front if its shortest edge is so many times the front's circumradius
// (equilateral faces: square root of 3). From shorter edges the front would make thin faces.
constexpr double kShortestFrontEdge = 1, kLongestFrontEdge = 1.8;
// Boundary edges are split down to this share of the wanted spacing, no further; so small angles
// between boundary edges cannot make the refinement go on for ever.
constexpr double kShortestBoundaryEdge = 0.01;
// Thin faces whose circumradius is below this share of the wanted spacing stay: features of the
// input that are so much finer than the filter do not deserve nodes.
constexpr double kFinestCircumradius = 1e-3;
// Lengths that differ by less are equal: on regular meshes many are, and rounding must not decide.
constexpr double kSame = 1e-9;
// Nodes for the sake of shape end at so many times those for the sake of size.
constexpr Index kNodesForShape = 4;
// They leave some of the nodes that there may be: new ones can make faces too large again.
constexpr double kShareForShape = 0.9;
// A circumcentre whose barycentric coordinate is below this goes onto the edge.
constexpr double kOnEdge = 1e-3;

class Refiner {
 public:
  Refiner(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
          const Remoteness& remoteness, const RefineOptions& options, CutEdges& cuts)
      : t_(triangulation),
        remoteness_(remoteness),
        options_(options),
        sine_(std::sin(options.min_angle_degrees * std::numbers::pi / 180)),
        near_(std::move(vertex_spacing)),
        cuts_(cuts) {
    wanted_.reserve(near_.size());
    for (Index v = 0; v < near_.size(); ++v)
      wanted_.push_back(near_[v] + remoteness_(t_.location(v)));
  }

  void run(RefineReport& report) {
    report.flips = t_.flip_to_delaunay();
    for (Index f = t_.edges().face_count(); f-- > 0;) push(f);
    Index face = kNone;
    for (int face_class = 0; bad_.pop(face, face_class);) {
      if (class_of(face) != face_class) continue;  // has changed since
      if (face_class == BadFaces::kThin && !may_insert_for_shape()) continue;
      if (t_.node_count() >= options_.max_nodes) {
        throw TooManyNodes("the node spacing would need more than " +
                           std::to_string(options_.max_nodes) + " nodes");
      }
      flips_ = 0;
      improve(face);
      report.flips += flips_;
    }
    report.insertions = t_.node_count() - t_.input().vertex_count();
    report.smallest_angle_degrees = smallest_angle() * 180 / std::numbers::pi;
  }

 private:
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
    return node < t_.input().vertex_count() && t_.total_angle(node) < std::numbers::pi / 3 + 1e-9;
  }

  // Good shapes need some more nodes than the right sizes do. Where a surface is a needle or a
  // strip beside its length they would need any number: these stay thin.
  bool may_insert_for_shape() {
    if (sized_nodes_ == 0) sized_nodes_ = t_.node_count();
    return t_.node_count() < kNodesForShape * sized_nodes_ + 1000 &&
           t_.node_count() < kShareForShape * options_.max_nodes;
  }

  // Nothing is asked of the shape of faces where no nodes are needed.
  bool remote(Index f) const {
    const HalfEdges& e = t_.edges();
    return wanted_[e.tail[3 * f]] > near_[e.tail[3 * f]] &&
           wanted_[e.tail[3 * f + 1]] > near_[e.tail[3 * f + 1]] &&
           wanted_[e.tail[3 * f + 2]] > near_[e.tail[3 * f + 2]];
  }

  double largest_radius(Index f) const {
    const HalfEdges& e = t_.edges();
    return kCircumradiusPerSpacing / 3 *
           (wanted_[e.tail[3 * f]] + wanted_[e.tail[3 * f + 1]] + wanted_[e.tail[3 * f + 2]]);
  }
  // Flat triangles have large circumcircles, however short they are: those are thin, not large.
  bool is_large(Index f, double radius, double largest) const {
    const HalfEdges& e = t_.edges();
    const double longest = std::max({e.length[3 * f], e.length[3 * f + 1], e.length[3 * f + 2]});
    return radius > (1 + kSame) * largest && longest > largest;
  }
  bool too_large(Index f) const {
    return is_large(f, t_.edges().circumradius(f), largest_radius(f));
  }

  static bool at_front(double shortest_edge, double largest_radius) {
    const double radius = kFrontRadius * largest_radius;
    return shortest_edge >= kShortestFrontEdge * radius &&
           shortest_edge <= kLongestFrontEdge * radius;
  }

  // The class of a face that is too large or too thin.
  int class_of(Index f) const {
    const double radius = t_.edges().circumradius(f), largest = largest_radius(f);
    const double shortest = t_.edges().shortest_edge(f);
    if (is_large(f, radius, largest)) {
      return at_front(shortest, largest) ? BadFaces::kFront : BadFaces::large(radius / largest);
    }
    if (radius * kCircumradiusPerSpacing < kFinestCircumradius * largest) return BadFaces::kNotBad;
    const bool thin = shortest < (1 - kSame) * 2 * radius * sine_ && !forced(f) && !remote(f);
    return thin ? BadFaces::kThin : BadFaces::kNotBad;
  }

  void push(Index f) {
    const int face_class = class_of(f);
    if (face_class != BadFaces::kNotBad) bad_.push(f, face_class);
  }

  // Where a node makes the face better, in its layout: the circumcentre, or at the front the place
  // on the way there from the middle of the shortest edge that makes a face of the front's size
  // with that edge (Rebay 1993).
  Vec2 better_node(Index f, const std::array<Vec2, 3>& at) const {
    const HalfEdges& e = t_.edges();
    Index k = 0;
    for (const Index other : {1U, 2U}) {
      if (e.length[3 * f + other] < (1 - kSame) * e.length[3 * f + k]) k = other;
    }
    const double l = e.length[3 * f + k];
    const Vec2 &a = at[k], &b = at[(k + 1) % 3], c = at[(k + 2) % 3] - a;
    const Vec2 along = (b - a) / l, up(-along.y(), along.x());
    const double height = std::max(c.dot(up), 1e-300), x = c.dot(along);
    double rise = (x * (x - l) + height * height) / (2 * height);  // of the circumcentre
    if (const double largest = largest_radius(f); at_front(l, largest)) {
      const double radius = kFrontRadius * largest;
      rise = std::min(rise, radius + std::sqrt(radius * radius - l * l / 4));
    }
    return (a + b) / 2 + rise * up;
  }

  // Walk from the face's centroid to a goal in its layout over the intrinsic faces. Returns the
  // face that holds it with barycentric coordinates, or the boundary half-edge in between.
  struct Destination {
    NodePoint point;
    Index blocked_by = kNone;
  };
  Destination walk_to(Index f, std::array<Vec2, 3> at, const Vec2& goal) const {
    const HalfEdges& e = t_.edges();
    const Vec2 from = (at[0] + at[1] + at[2]) / 3, way = goal - from;
    Index entry = kNone;
    for (int step = 0; step < 100000; ++step) {
      double nearest = 1 - kSame;
      Index leave = kNone;
      for (Index k = 0; k < 3; ++k) {
        if (k == entry) continue;
        const Vec2 side = at[(k + 1) % 3] - at[k], to = from - at[k];
        const double closing = -cross(side, way);
        if (!(closing > 0)) continue;
        const double reach = cross(side, to) / closing;
        if (reach < nearest) {
          nearest = reach - kSame;
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
    if (e.twin[3 * p.face] != kNone && e.twin[3 * p.face + 1] != kNone &&
        e.twin[3 * p.face + 2] != kNone) {
      return kNone;
    }
    const std::array<Vec2, 3> at = e.layout(p.face);
    const Vec2 x = interpolate(at, p.barycentric);
    for (Index k = 0; k < 3; ++k) {
      if (e.twin[3 * p.face + k] == kNone &&
          (at[k] - x).dot(at[(k + 1) % 3] - x) <
              -kSame * e.length[3 * p.face + k] * e.length[3 * p.face + k])
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

  void improve(Index f) {
    const std::array<Vec2, 3> at = t_.edges().layout(f);
    Destination to = walk_to(f, at, better_node(f, at));
    if (to.blocked_by == kNone) to.blocked_by = encroached(to.point);
    if (!too_large(f) && at_needle(to)) return;
    if (to.blocked_by != kNone) {
      if (!split_boundary(to.blocked_by)) return;
    } else {
      insert(to.point);
    }
    push(f);
  }

  void insert(const NodePoint& point) {
    const HalfEdges& e = t_.edges();
    const Index g = point.face;
    Vec3 b = point.barycentric;
    const std::array<Vec2, 3> at = e.layout(g);
    const Vec2 x = interpolate(at, b);
    double spacing = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < 3; ++k) {
      spacing = std::min(spacing, near_[e.tail[3 * g + k]] + options_.growth * (x - at[k]).norm());
    }
    // Close to an edge, onto it: a flat triangle's lengths would not tell its height.
    Index least = 0;
    b.minCoeff(&least);
    const Index h = 3 * g + (least + 1) % 3;
    if (b[least] < kOnEdge && e.twin[h] != kNone &&
        t_.split(h, b[(least + 2) % 3] / (1 - b[least])) != kNone) {
      return finish(spacing);
    }
    b = b.cwiseMax(kOnEdge);
    b /= b.sum();
    t_.insert(g, b);
    finish(spacing);
  }

  // Halve a boundary edge, on all its sides if it is on a cut; false if it is too short.
  bool split_boundary(Index h) {
    const HalfEdges& e = t_.edges();
    const Index a = e.tail[h], b = e.tip(h);
    const double half = 0.5 * e.length[h];
    if (2 * half < kShortestBoundaryEdge * std::min(wanted_[a], wanted_[b])) return false;
    const double spacing = std::min(near_[a], near_[b]) + options_.growth * half;
    const std::span<const CutEdges::Side> sides = cuts_.sides(a);
    if (sides.empty()) {
      t_.split(h, 0.5);
      finish(spacing);
      return true;
    }
    std::vector<Index> middles;
    for (const CutEdges::Side& side : sides) {
      middles.push_back(t_.split(t_.outgoing(side.tail), 0.5));
      finish(spacing);
    }
    cuts_.split(a, middles);
    return true;
  }

  // Give the node that was inserted last its spacing, by what its neighbours allow, and mend the
  // faces around it.
  void finish(double allowed) {
    const Index node = t_.node_count() - 1;
    const SurfacePoint& location = t_.location(node);
    near_.push_back(std::min(allowed, largest_spacing(options_, location)));
    wanted_.push_back(near_.back() + remoteness_(location));
    flips_ += t_.restore_delaunay(node);
    Index spoke = t_.outgoing(node);
    do {
      push(HalfEdges::face(spoke));
      spoke = t_.edges().rotate(spoke);
    } while (spoke != kNone && spoke != t_.outgoing(node));
  }

  double smallest_angle() const {
    double least = std::numbers::pi;
    for (Index f = 0; f < t_.edges().face_count(); ++f) {
      if (forced(f) || remote(f)) continue;
      for (Index k = 0; k < 3; ++k) least = std::min(least, t_.edges().corner_angle(3 * f + k));
    }
    return least;
  }

  IntrinsicTriangulation& t_;
  const Remoteness& remoteness_;
  const RefineOptions& options_;
  const double sine_;
  std::vector<double> near_;    // per node: the spacing wanted where nodes are needed
  std::vector<double> wanted_;  // per node: the same with what is added far from there
  CutEdges& cuts_;
  BadFaces bad_;
  Index flips_ = 0;
  Index sized_nodes_ = 0;  // nodes once all faces were small enough for the first time
};

}  // namespace

void refine_delaunay(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
                     const Remoteness& remoteness, const RefineOptions& options, CutEdges& cuts,
                     RefineReport& report) {
  Refiner(triangulation, std::move(vertex_spacing), remoteness, options, cuts).run(report);
}

}  // namespace onmesh
