#include "onmesh/delaunay_refine.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "onmesh/error.h"

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

/// Bad faces, in classes of circumradius: within a class the one that came last goes first. So the
/// refinement works its way from place to place, in memory that is still in the cache, and new
/// nodes are neighbours of the ones before.
class BadFaces {
 public:
  static constexpr int kNotBad = -1;

  /// \param size circumradius as a share of the largest one allowed, > 0
  static int class_of(double size) {
    return std::clamp(std::ilogb(size * size) + kClasses / 2, 0, kClasses - 1);
  }
  void push(Index face, int size_class) {
    classes_[std::size_t(size_class)].push_back(face);
    largest_ = std::max(largest_, size_class);
  }
  /// \return false if there are none left
  bool pop(Index& face, int& size_class) {
    while (largest_ >= 0 && classes_[std::size_t(largest_)].empty()) --largest_;
    if (largest_ < 0) return false;
    size_class = largest_;
    face = classes_[std::size_t(largest_)].back();
    classes_[std::size_t(largest_)].pop_back();
    return true;
  }

 private:
  static constexpr int kClasses = 128;
  std::array<std::vector<Index>, kClasses> classes_;
  int largest_ = -1;
};

class Refiner {
 public:
  Refiner(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
          const Remoteness& remoteness, const RefineOptions& options, Seams& seams)
      : t_(triangulation),
        remoteness_(remoteness),
        options_(options),
        sine_(std::sin(options.min_angle_degrees * std::numbers::pi / 180)),
        near_(std::move(vertex_spacing)),
        seams_(seams) {
    wanted_.reserve(near_.size());
    for (Index v = 0; v < near_.size(); ++v) wanted_.push_back(near_[v] + remoteness_(t_.location(v)));
  }

  void run(RefineReport& report) {
    report.flips = t_.flip_to_delaunay();
    for (Index f = t_.edges().face_count(); f-- > 0;) push(f);
    Index face = kNone;
    for (int size_class = 0; bad_.pop(face, size_class);) {
      if (class_of(face) != size_class) continue;  // has changed since
      if (t_.node_count() >= options_.max_nodes) {
        throw InputError("the node spacing would need more than " +
                         std::to_string(options_.max_nodes) + " nodes");
      }
      flips_ = 0;
      improve(face);
      report.flips += flips_;
    }
    report.insertions = t_.node_count() - t_.input_vertex_count();
    report.smallest_angle_degrees = smallest_angle() * 180 / std::numbers::pi;
  }

 private:
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
  bool too_large(Index f) const { return circumradius(f) > largest_radius(f); }

  // The class of a face that is too large or too thin.
  int class_of(Index f) const {
    const HalfEdges& e = t_.edges();
    const double radius = circumradius(f), size = radius / largest_radius(f);
    if (size > 1) return BadFaces::class_of(size);
    if (size * kCircumradiusPerSpacing < kFinestCircumradius) return BadFaces::kNotBad;
    const double shortest = std::min({e.length[3 * f], e.length[3 * f + 1], e.length[3 * f + 2]});
    const bool thin = shortest < 2 * radius * sine_ && !forced(f) && !remote(f);
    return thin ? BadFaces::class_of(size) : BadFaces::kNotBad;
  }

  void push(Index f) {
    const int size_class = class_of(f);
    if (size_class != BadFaces::kNotBad) bad_.push(f, size_class);
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
    if (e.twin[3 * p.face] != kNone && e.twin[3 * p.face + 1] != kNone &&
        e.twin[3 * p.face + 2] != kNone) {
      return kNone;
    }
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

  void improve(Index f) {
    Destination to = walk_to_circumcentre(f);
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
    const Vec2 x = at[0] * b[0] + at[1] * b[1] + at[2] * b[2];
    double spacing = options_.spacing;
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

  // Halve a boundary edge, on all its sides if it is on a seam; false if it is too short.
  bool split_boundary(Index h) {
    const HalfEdges& e = t_.edges();
    const Index a = e.tail[h], b = e.tip(h);
    const double half = 0.5 * e.length[h];
    if (2 * half < kShortestBoundaryEdge * std::min(wanted_[a], wanted_[b])) return false;
    const double spacing =
        std::min(options_.spacing, std::min(near_[a], near_[b]) + options_.growth * half);
    const std::span<const Seams::Side> sides = seams_.sides(a);
    if (sides.empty()) {
      t_.split(h, 0.5);
      finish(spacing);
      return true;
    }
    std::vector<Index> middles;
    for (const Seams::Side& side : sides) {
      middles.push_back(t_.split(t_.outgoing(side.tail), 0.5));
      finish(spacing);
    }
    seams_.split(a, middles);
    return true;
  }

  // Give the node that was inserted last its spacing, and mend the faces around it.
  void finish(double spacing) {
    const Index node = t_.node_count() - 1;
    near_.push_back(spacing);
    wanted_.push_back(spacing + remoteness_(t_.location(node)));
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
  Seams& seams_;
  BadFaces bad_;
  Index flips_ = 0;
};

}  // namespace

void refine_delaunay(IntrinsicTriangulation& triangulation, std::vector<double> vertex_spacing,
                     const Remoteness& remoteness, const RefineOptions& options, Seams& seams,
                     RefineReport& report) {
  Refiner(triangulation, std::move(vertex_spacing), remoteness, options, seams).run(report);
}

}  // namespace onmesh
