#include "onmesh/nodes/bisection.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "onmesh/nodes/sizing_field.h"
#include "onmesh/nodes/too_many_nodes.h"

namespace onmesh {
namespace {

// Right isosceles faces of this longest edge, in spacings, have a circumradius of 0.7 spacings.
constexpr double kLongestPerSpacing = 1.4;

/// The faces while they are split. Edges have numbers of their own, so that nothing is ever looked
/// up by its ends.
class Bisection {
 public:
  Bisection(const TriangleMesh& mesh, const RefineOptions& options)
      : mesh_(mesh), options_(options), remoteness_(mesh, options) {
    const EdgeTable table(mesh);
    near_ = wanted_spacing(mesh, table, options);
    positions_ = mesh.positions;
    nodes_.resize(mesh.positions.size());
    edges_.reserve(table.size());
    faces_.resize(mesh.faces.size());
    next_side_.assign(3 * mesh.faces.size(), kNone);
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      faces_[f].input = f;
      faces_[f].nodes = mesh.faces[f];
      faces_[f].at = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
      for (int k = 0; k < 3; ++k) {
        SurfacePoint& node = nodes_[mesh.faces[f][k]];
        if (node.face == kNone) node = {f, Vec3::Unit(k)};
      }
    }
    wanted_.reserve(near_.size());
    for (Index v = 0; v < near_.size(); ++v) wanted_.push_back(near_[v] + remoteness_(nodes_[v]));
    for (std::size_t e = 0; e < table.size(); ++e) {
      const auto [a, b] = table.vertices(e);
      const Index edge = add_edge(a, b, (positions_[b] - positions_[a]).norm());
      for (std::size_t i = table.sides(e).size(); i-- > 0;) {
        const EdgeSide& s = table.sides(e)[i];
        attach(edge, s.face, s.corner);
      }
    }
  }

  void run() {
    // Faces that splitting appends come later in the same pass; those that keep their number are
    // looked at until they are small enough.
    for (Index f = 0; f < faces_.size(); ++f) {
      while (too_large(f)) split(longest_edge_on_path(f));
    }
  }

  NodeSurface surface() const {
    NodeSurface result;
    NodeMesh& out = result.nodes;
    out.nodes = nodes_;
    out.faces.reserve(faces_.size());
    out.lengths.reserve(faces_.size());
    out.neighbours.assign(faces_.size(), {kNone, kNone, kNone});
    Overlay& overlay = result.overlay;
    overlay.face_offsets.assign(mesh_.faces.size() + 1, 0);
    for (const Face& face : faces_) {
      out.faces.push_back(face.nodes);
      out.lengths.push_back({edges_[face.edges[0]].length, edges_[face.edges[1]].length,
                             edges_[face.edges[2]].length});
      ++overlay.face_offsets[face.input + 1];
    }
    for (const Edge& edge : edges_) {
      const Index a = edge.first_side, b = a == kNone ? kNone : next_side_[a];
      if (b == kNone || next_side_[b] != kNone) continue;
      out.neighbours[a / 3][a % 3] = b;
      out.neighbours[b / 3][b % 3] = a;
    }
    out.build_incidence();
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      overlay.face_offsets[f + 1] += overlay.face_offsets[f];
    }
    overlay.pieces.resize(faces_.size());
    std::vector<Index> next(overlay.face_offsets.begin(), overlay.face_offsets.end() - 1);
    for (Index f = 0; f < faces_.size(); ++f) {
      Eigen::Matrix3d corners;  // columns: barycentric coordinates in the input face
      for (int k = 0; k < 3; ++k) corners.col(k) = to_barycentric(faces_[f].at[k]);
      overlay.pieces[next[faces_[f].input]++] = {f, corners.inverse()};
    }
    return result;
  }

  double smallest_angle() const {
    double least = std::numbers::pi;
    for (const Face& face : faces_) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 a = positions_[face.nodes[(k + 1) % 3]] - positions_[face.nodes[k]];
        const Vec3 b = positions_[face.nodes[(k + 2) % 3]] - positions_[face.nodes[k]];
        least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
      }
    }
    return least;
  }

 private:
  struct Edge {
    std::array<Index, 2> ends;
    double length;
    Index first_side = kNone;  // 3 face + corner; the others follow in next_side_
  };
  struct Face {
    Index input = kNone;
    std::array<Index, 3> nodes{}, edges{};  // edge k runs from corner k to the next
    std::array<Vec2, 3> at;                 // corners in the input face: its coordinates b1, b2
  };

  static Vec3 to_barycentric(const Vec2& at) { return {1 - at.x() - at.y(), at.x(), at.y()}; }

  Index add_edge(Index a, Index b, double length) {
    edges_.push_back({{a, b}, length});
    return static_cast<Index>(edges_.size() - 1);
  }

  void attach(Index edge, Index face, Index corner) {
    const Index side = 3 * face + corner;
    faces_[face].edges[corner] = edge;
    next_side_[side] = edges_[edge].first_side;
    edges_[edge].first_side = side;
  }

  // A side of the edge gets another number.
  void rename(Index edge, Index from, Index to) {
    Index* link = &edges_[edge].first_side;
    while (*link != from) link = &next_side_[*link];
    *link = to;
    next_side_[to] = next_side_[from];
  }

  // Edges in a strict order: by length, then by number. Faces around an edge agree on it.
  bool shorter(Index a, Index b) const {
    return edges_[a].length != edges_[b].length ? edges_[a].length < edges_[b].length : a > b;
  }

  Index longest_edge(Index f) const {
    const auto& e = faces_[f].edges;
    const Index longer = shorter(e[0], e[1]) ? e[1] : e[0];
    return shorter(longer, e[2]) ? e[2] : longer;
  }

  bool too_large(Index f) const {
    const auto& n = faces_[f].nodes;
    const double wanted = (wanted_[n[0]] + wanted_[n[1]] + wanted_[n[2]]) / 3;
    const bool at_once = options_.any_shape && !options_.least_useful.empty();
    const double useful = at_once ? options_.least_useful[faces_[f].input] : 0;
    return edges_[longest_edge(f)].length > kLongestPerSpacing * std::max(wanted, useful);
  }

  // From face to face over longest edges, to one that is the longest of all its faces.
  Index longest_edge_on_path(Index f) const {
    Index edge = longest_edge(f);
    for (bool longer = true; longer;) {
      longer = false;
      for (Index s = edges_[edge].first_side; s != kNone && !longer; s = next_side_[s]) {
        const Index other = longest_edge(s / 3);
        if (other == edge) continue;
        edge = other;
        longer = true;
      }
    }
    return edge;
  }

  Index add_node(Index edge) {
    if (nodes_.size() >= options_.max_nodes) {
      throw TooManyNodes("the node spacing would need more than " +
                         std::to_string(options_.max_nodes) + " nodes");
    }
    const auto [a, b] = edges_[edge].ends;
    const double half = edges_[edge].length / 2;
    const Vec3 position = (positions_[a] + positions_[b]) / 2;
    double allowed = std::min(near_[a], near_[b]) + options_.growth * half;
    Index lowest =
        kNone;  // of the sides: where the node is said to lie must not hang on their order
    for (Index s = edges_[edge].first_side; s != kNone; s = next_side_[s]) {
      const Index apex = faces_[s / 3].nodes[(s % 3 + 2) % 3];
      allowed =
          std::min(allowed, near_[apex] + options_.growth * (positions_[apex] - position).norm());
      lowest = std::min(lowest, s);
    }
    const Face& face = faces_[lowest / 3];
    const Vec2 at = (face.at[lowest % 3] + face.at[(lowest % 3 + 1) % 3]) / 2;
    nodes_.push_back({face.input, to_barycentric(at)});
    positions_.push_back(position);
    near_.push_back(std::min(allowed, largest_spacing(options_, nodes_.back())));
    wanted_.push_back(near_.back() + remoteness_(nodes_.back()));
    return static_cast<Index>(nodes_.size() - 1);
  }

  // Split all faces on the edge at its middle.
  void split(Index edge) {
    const Index middle = add_node(edge);
    const auto [first, second] = edges_[edge].ends;
    const double half = edges_[edge].length / 2;
    const Index near = add_edge(first, middle, half), far = add_edge(middle, second, half);
    for (Index s = edges_[edge].first_side, next = kNone; s != kNone; s = next) {
      next = next_side_[s];
      const Index f = s / 3, k = s % 3, l = (k + 1) % 3, apex = (k + 2) % 3;
      const Index g = static_cast<Index>(faces_.size());
      // f keeps the half at its corner k, g gets the one at corner l.
      Face other = faces_[f];
      const Vec2 at = (other.at[k] + other.at[l]) / 2;
      const Index from = other.nodes[k], across = other.edges[l];
      other.nodes[k] = middle;
      other.at[k] = at;
      faces_.push_back(other);
      next_side_.insert(next_side_.end(), 3, kNone);
      faces_[f].nodes[l] = middle;
      faces_[f].at[l] = at;
      rename(across, 3 * f + l, 3 * g + l);
      attach(from == first ? near : far, f, k);
      attach(from == first ? far : near, g, k);
      const Index tip = other.nodes[apex];
      const Index inner = add_edge(middle, tip, (positions_[tip] - positions_[middle]).norm());
      attach(inner, f, l);
      attach(inner, g, apex);
    }
    edges_[edge].first_side = kNone;
  }

  const TriangleMesh& mesh_;
  const RefineOptions& options_;
  const Remoteness remoteness_;
  std::vector<Vec3> positions_;  // per node
  std::vector<double> near_;     // per node: the spacing wanted where nodes are needed
  std::vector<double> wanted_;   // per node: the same with what is added far from there
  std::vector<SurfacePoint> nodes_;
  std::vector<Edge> edges_;  // those that were split have no side
  std::vector<Face> faces_;
  std::vector<Index> next_side_;  // per side
};

}  // namespace

NodeSurface refine_by_bisection(const TriangleMesh& mesh, const RefineOptions& options,
                                RefineReport* report) {
  check_refine_options(mesh, options);
  Bisection bisection(mesh, options);
  bisection.run();
  NodeSurface surface = bisection.surface();
  if (report != nullptr) {
    *report = {};
    report->bisected = true;
    report->input_vertices = static_cast<Index>(mesh.positions.size());
    report->nodes = static_cast<Index>(surface.nodes.nodes.size());
    report->faces = static_cast<Index>(surface.nodes.faces.size());
    report->insertions = report->nodes - report->input_vertices;
    report->smallest_angle_degrees = bisection.smallest_angle() * 180 / std::numbers::pi;
  }
  return surface;
}

}  // namespace onmesh
