#include "onmesh/nodes/sizing_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "onmesh/mesh/vertex_fans.h"

namespace onmesh {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Links with more faces are not measured: distances certainly bend there.
constexpr std::size_t kLargestLink = 64;
/// Makes the spacing the finest, however much larger it is elsewhere.
constexpr double kSharpestBend = 2 * kPi;

double corner_angle(const TriangleMesh& mesh, Index face, std::size_t k) {
  const auto c = mesh.corners(face);
  const Vec3 a = c[(k + 1) % 3] - c[k], b = c[(k + 2) % 3] - c[k];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A vertex's link: its edges are the graph's nodes, numbered by their far ends; every face joins
/// two by an arc as long as its angle.
struct Link {
  struct Arc {
    std::size_t from, to;
    double angle;
  };
  std::vector<Index> ends;
  std::vector<Arc> arcs;

  std::size_t number(Index end) {
    const auto at = std::size_t(std::find(ends.begin(), ends.end(), end) - ends.begin());
    if (at == ends.size()) ends.push_back(end);
    return at;
  }

  /// Least angles from a node to all, one arc left out (Bellman-Ford: links are small).
  std::vector<double> angles_from(std::size_t node, std::size_t without) const {
    std::vector<double> angle(ends.size(), kInfinity);
    angle[node] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < arcs.size(); ++i) {
        if (i == without) continue;
        const Arc& arc = arcs[i];
        for (const auto& [a, b] : {std::pair(arc.from, arc.to), std::pair(arc.to, arc.from)}) {
          if (angle[a] + arc.angle >= angle[b]) continue;
          angle[b] = angle[a] + arc.angle;
          changed = true;
        }
      }
    }
    return angle;
  }

  double bend() const {
    double bend = 0;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const double around = angles_from(arcs[i].from, i)[arcs[i].to] + arcs[i].angle;
      if (around < kInfinity) bend = std::max(bend, std::abs(2 * kPi - around));
    }
    for (std::size_t n = 0; n < ends.size(); ++n) {
      for (const double angle : angles_from(n, arcs.size())) bend = std::max(bend, angle - kPi);
    }
    return std::min(bend, kSharpestBend);
  }
};

/// What is known of a vertex from its edges and faces alone.
struct Around {
  double angle = 0, area = 0;   ///< area: a third of the faces'
  Index faces = 0, border = 0;  ///< edges with one face
  bool branches = false;
};

}  // namespace

std::vector<double> wanted_spacing(const TriangleMesh& mesh, const EdgeTable& edges,
                                   const RefineOptions& options) {
  const std::size_t vertices = mesh.positions.size();
  std::vector<Around> around(vertices);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      Around& at = around[mesh.faces[f][k]];
      at.angle += corner_angle(mesh, f, k);
      at.area += mesh.face_area(f) / 3;
      ++at.faces;
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (const Index v : edges.vertices(e)) {
      around[v].border += edges.sides(e).size() == 1;
      around[v].branches = around[v].branches || edges.sides(e).size() > 2;
    }
  }
  DisjointSets fans = join_fans(mesh, edges);
  const std::vector<Index> fan_count = count_fans(mesh, fans);

  // The links of vertices that are not manifold.
  std::vector<Index> link_of(vertices, kNone);
  std::vector<Link> links;
  for (Index v = 0; v < vertices; ++v) {
    if (!around[v].branches && fan_count[v] < 2) continue;
    link_of[v] = static_cast<Index>(links.size());
    links.emplace_back();
  }
  for (Index f = 0; f < mesh.faces.size() && !links.empty(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& face = mesh.faces[f];
      const Index v = face[k];
      if (link_of[v] == kNone || around[v].faces > kLargestLink) continue;
      Link& link = links[link_of[v]];
      const std::size_t from = link.number(face[(k + 1) % 3]);
      link.arcs.push_back({from, link.number(face[(k + 2) % 3]), corner_angle(mesh, f, k)});
    }
  }

  const double curved = options.curved > 0 ? options.curved : options.spacing;
  const double finest = options.finest > 0 ? options.finest : curved / 4;
  std::vector<double> spacing(vertices, options.spacing);
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (Index v = 0; v < vertices; ++v) {
    if (around[v].faces == 0) continue;
    double bend = around[v].border > 0 ? std::max(0.0, around[v].angle - kPi)
                                       : std::abs(2 * kPi - around[v].angle);
    if (link_of[v] != kNone) {
      bend = around[v].faces > kLargestLink ? kSharpestBend : links[link_of[v]].bend();
    }
    // |K| is the angle that is missing or too much, per area (Gauss-Bonnet).
    const double by_curvature =
        std::sqrt(options.flatness * std::max(around[v].area, options.spread) / bend);
    const double smooth =
        bend > 0 ? std::min(std::max(by_curvature, curved), options.spacing) : options.spacing;
    spacing[v] = std::max(finest, smooth / (1 + options.sharpness * bend));
    if (spacing[v] < options.spacing) front.emplace(spacing[v], v);
  }
  if (front.empty()) return spacing;

  std::vector<std::size_t> offsets(vertices + 1, 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (const Index v : edges.vertices(e)) ++offsets[v + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) offsets[v + 1] += offsets[v];
  std::vector<Index> ends(offsets.back());
  std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges.vertices(e);
    ends[next[a]++] = b;
    ends[next[b]++] = a;
  }
  while (!front.empty()) {
    const auto [reached, v] = front.top();
    front.pop();
    if (reached > spacing[v]) continue;
    for (std::size_t i = offsets[v]; i < offsets[v + 1]; ++i) {
      const Index to = ends[i];
      const double there =
          reached + options.growth * (mesh.positions[to] - mesh.positions[v]).norm();
      if (there >= spacing[to]) continue;
      spacing[to] = there;
      front.emplace(there, to);
    }
  }
  return spacing;
}

}  // namespace onmesh
