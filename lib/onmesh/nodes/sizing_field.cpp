#include "onmesh/nodes/sizing_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "onmesh/base/error.h"
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

  /// How far the shortest cycle through an arc is from 2 pi, or two nodes are apart beyond pi.
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

std::vector<Around> look_around(const TriangleMesh& mesh, const EdgeTable& edges) {
  std::vector<Around> around(mesh.positions.size());
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
  return around;
}

/// The links of vertices that are not manifold.
struct Links {
  std::vector<Index> of_vertex;  ///< kNone at the others
  std::vector<Link> links;
};

Links find_links(const TriangleMesh& mesh, const EdgeTable& edges,
                 const std::vector<Around>& around) {
  DisjointSets fans = join_fans(mesh, edges);
  const std::vector<Index> fan_count = count_fans(mesh, fans);
  Links result;
  result.of_vertex.assign(around.size(), kNone);
  for (Index v = 0; v < around.size(); ++v) {
    if (!around[v].branches && fan_count[v] < 2) continue;
    result.of_vertex[v] = static_cast<Index>(result.links.size());
    result.links.emplace_back();
  }
  for (Index f = 0; f < mesh.faces.size() && !result.links.empty(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& face = mesh.faces[f];
      const Index v = face[k];
      if (result.of_vertex[v] == kNone || around[v].faces > kLargestLink) continue;
      Link& link = result.links[result.of_vertex[v]];
      const std::size_t from = link.number(face[(k + 1) % 3]);
      link.arcs.push_back({from, link.number(face[(k + 2) % 3]), corner_angle(mesh, f, k)});
    }
  }
  return result;
}

/// How much distances bend at each vertex, radians.
std::vector<double> bends(const TriangleMesh& mesh, const EdgeTable& edges,
                          const std::vector<Around>& around) {
  const Links links = find_links(mesh, edges, around);
  std::vector<double> result(around.size(), 0);
  for (Index v = 0; v < around.size(); ++v) {
    const Around& at = around[v];
    if (at.faces == 0) continue;
    if (const Index link = links.of_vertex[v]; link != kNone) {
      result[v] = at.faces > kLargestLink ? kSharpestBend : links.links[link].bend();
    } else {
      result[v] = at.border > 0 ? std::max(0.0, at.angle - kPi) : std::abs(2 * kPi - at.angle);
    }
  }
  return result;
}

/// The spacing at a vertex where distances bend by so many radians, whatever is wanted around it.
double spacing_at(double bend, double area, const RefineOptions& options) {
  const double curved = options.curved > 0 ? options.curved : options.spacing;
  const double finest = options.finest > 0 ? options.finest : curved / 4;
  // |K| is the angle that is missing or too much, per area (Gauss-Bonnet).
  const double by_curvature = std::sqrt(options.flatness * std::max(area, options.spread) / bend);
  const double smooth =
      bend > 0 ? std::min(std::max(by_curvature, curved), options.spacing) : options.spacing;
  return std::max(finest, smooth / (1 + options.sharpness * bend));
}

/// Vertices joined by edges (CSR).
struct Neighbours {
  std::vector<std::size_t> offsets;
  std::vector<Index> ends;

  Neighbours(const EdgeTable& edges, std::size_t vertices) : offsets(vertices + 1, 0) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (const Index v : edges.vertices(e)) ++offsets[v + 1];
    }
    for (std::size_t v = 0; v < vertices; ++v) offsets[v + 1] += offsets[v];
    ends.resize(offsets.back());
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto [a, b] = edges.vertices(e);
      ends[next[a]++] = b;
      ends[next[b]++] = a;
    }
  }
};

/// Vertices around which every face with area is to have no nodes.
std::vector<bool> spared_vertices(const TriangleMesh& mesh, const RefineOptions& options) {
  std::vector<bool> spared(mesh.positions.size(), false), used = spared;
  for (Index f = 0; f < options.least_useful.size(); ++f) {
    if (mesh.is_degenerate(f)) continue;
    const bool is_spared = options.least_useful[f] == kNoNodes;
    for (const Index v : mesh.faces[f]) (is_spared ? spared : used)[v] = true;
  }
  for (Index v = 0; v < spared.size(); ++v) spared[v] = spared[v] && !used[v];
  return spared;
}

/// Lower the spacing around each vertex to what its own and `growth` allow along the edges
/// (Dijkstra's algorithm from all vertices at once, the finest first).
void limit_growth(const TriangleMesh& mesh, const EdgeTable& edges, double flat, double growth,
                  std::vector<double>& spacing) {
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (Index v = 0; v < spacing.size(); ++v) {
    if (spacing[v] < flat) front.emplace(spacing[v], v);
  }
  if (front.empty()) return;
  const Neighbours neighbours(edges, spacing.size());
  while (!front.empty()) {
    const auto [reached, v] = front.top();
    front.pop();
    if (reached > spacing[v]) continue;
    for (std::size_t i = neighbours.offsets[v]; i < neighbours.offsets[v + 1]; ++i) {
      const Index to = neighbours.ends[i];
      const double there = reached + growth * (mesh.positions[to] - mesh.positions[v]).norm();
      if (there >= spacing[to]) continue;
      spacing[to] = there;
      front.emplace(there, to);
    }
  }
}

}  // namespace

void check_refine_options(const TriangleMesh& mesh, const RefineOptions& options) {
  const auto require = [](bool holds, const char* option, const char* problem) {
    if (!holds) throw OptionError(option, problem);
  };
  const auto in = [](double x, double low, double high) { return x >= low && x <= high; };
  constexpr double kHuge = std::numeric_limits<double>::max();
  require(options.spacing > 0 && options.spacing <= kHuge, "spacing",
          "must be positive and finite");
  require(in(options.curved, 0, options.spacing), "curved", "must be between 0 and spacing");
  require(in(options.finest, 0, options.spacing), "finest", "must be between 0 and spacing");
  require(in(options.flatness, 0, kHuge), "flatness", "must be finite and not negative");
  require(in(options.spread, 0, kHuge), "spread", "must be finite and not negative");
  require(in(options.sharpness, 0, kHuge), "sharpness", "must be finite and not negative");
  require(options.growth > 0 && options.growth <= kHuge, "growth", "must be positive and finite");
  require(in(options.min_angle_degrees, 0, 30), "min_angle_degrees", "must be between 0 and 30");
  require(in(options.reach, 0, kHuge), "reach", "must be finite and not negative");
  const auto per_face = [&](std::size_t size) { return size == 0 || size == mesh.faces.size(); };
  require(per_face(options.needed.size()), "needed", "one entry per face of the mesh is needed");
  require(per_face(options.least_useful.size()), "least_useful",
          "one entry per face of the mesh is needed");
}

double largest_spacing(const RefineOptions& options, const SurfacePoint& point) {
  if (options.least_useful.empty() || point.face == kNone) return options.spacing;
  return std::max(options.spacing, options.least_useful[point.face]);
}

std::vector<double> wanted_spacing(const TriangleMesh& mesh, const EdgeTable& edges,
                                   const RefineOptions& options) {
  const std::vector<Around> around = look_around(mesh, edges);
  const std::vector<double> bend = bends(mesh, edges, around);
  std::vector<double> spacing(mesh.positions.size(), options.spacing);
  const std::vector<bool> spared = spared_vertices(mesh, options);
  for (Index v = 0; v < spacing.size(); ++v) {
    if (around[v].faces > 0) spacing[v] = spacing_at(bend[v], around[v].area, options);
    if (spared[v]) spacing[v] = kNoNodes;
  }
  limit_growth(mesh, edges, options.spacing, options.growth, spacing);
  return spacing;
}

Remoteness::Remoteness(const TriangleMesh& mesh, const RefineOptions& options)
    : mesh_(mesh), options_(options) {
  const std::vector<bool>& needed = options.needed;
  if (needed.empty()) return;
  if (std::find(needed.begin(), needed.end(), false) == needed.end()) return;
  needed_.positions = mesh.positions;
  bool has_area = false;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!needed[f]) continue;
    needed_.faces.push_back(mesh.faces[f]);
    has_area = has_area || !mesh.is_degenerate(f);
  }
  if (has_area) nearest_.emplace(needed_);
}

double Remoteness::operator()(const SurfacePoint& point) const {
  if (!nearest_ || point.face == kNone || options_.needed[point.face]) return 0;
  const Vec3 at = mesh_.position(point);
  const double distance = (needed_.position(nearest_->closest(at)) - at).norm();
  return options_.growth * std::max(0.0, distance - options_.reach);
}

}  // namespace onmesh
