#include "onmesh/mesh/join_boundaries.h"

#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "onmesh/base/disjoint_sets.h"
#include "onmesh/mesh/match_edges.h"
#include "onmesh/mesh/split_edges.h"

namespace onmesh {
namespace {

/// How many steps of the stored coordinates two may be apart: a rounding in each of three
/// coordinates on either side comes to the root of three.
constexpr double kSteps = 2;

/// Vertices that come together.
struct Cluster {
  std::vector<Index> members;
  double tolerance;  ///< the least of the edges that meet here
};

class BoundaryJoin {
 public:
  BoundaryJoin(const TriangleMesh& mesh, std::optional<double> tolerance, JoinReport& report)
      : mesh_(mesh),
        report_(report),
        scaled_(mesh, tolerance),
        sets_(mesh.positions.size()),
        left_apart_(mesh.positions.size(), false) {}

  TriangleMesh run() {
    edges_ = boundary_edges(mesh_);
    const std::size_t before = edges_.size();
    join_edges();
    if (const auto splits = find_t_junctions(mesh_, edges_, scaled_, left_apart_);
        !splits.empty()) {
      const std::vector<Index> parts_of = split_faces(mesh_, splits);
      std::vector<Index> face;
      for (const Index f : parts_of) face.push_back(report_.face[f]);
      report_.face = std::move(face);
      report_.t_junctions = static_cast<Index>(splits.size());
      edges_ = boundary_edges(mesh_);
      join_edges();
    }
    // Every split makes two boundary edges of one. Some are one with others without more ado.
    const std::size_t split = before + report_.t_junctions;
    report_.joined_edges = static_cast<Index>((split - std::min(edges_.size(), split)) / 2);
    drop_merged_vertices();
    return std::move(mesh_);
  }

 private:
  /// Join what matches and renumber the faces; vertices keep their numbers for now.
  void join_edges() {
    const EdgeMatches matches = match_edges(mesh_, edges_, scaled_);
    report_.refused_edges = matches.ambiguous;
    if (matches.pairs.empty()) return;
    join_pairs(matches.pairs);
    for (auto& face : mesh_.faces) {
      for (Index& v : face) v = sets_.find(v);
    }
    edges_ = boundary_edges(mesh_);
  }

  void join_pairs(const std::vector<EdgeMatch>& pairs) {
    DisjointSets wanted = sets_;
    for (const EdgeMatch& pair : pairs) {
      for (const auto& [a, b] : pair.ends(edges_)) wanted.join(a, b);
    }
    const std::vector<bool> refused = find_refused(pairs, wanted);
    for (const EdgeMatch& pair : pairs) {
      const auto ends = pair.ends(edges_);
      if (refused[wanted.find(ends[0][0])] || refused[wanted.find(ends[1][0])]) {
        report_.refused_edges += 2;
        for (const auto& [a, b] : ends) {
          if (refused[wanted.find(a)]) left_apart_[a] = left_apart_[b] = true;
        }
        continue;
      }
      for (const auto& [a, b] : ends) sets_.join(a, b);
    }
  }

  /// Per vertex that stands for a cluster: its vertices are too far apart, or an edge would
  /// collapse.
  std::vector<bool> find_refused(const std::vector<EdgeMatch>& pairs, DisjointSets& wanted) {
    std::vector<bool> refused(mesh_.positions.size(), false);
    for (const auto& face : mesh_.faces) {
      if (has_repeated_vertex(face)) continue;
      const std::array<Index, 3> v{wanted.find(face[0]), wanted.find(face[1]),
                                   wanted.find(face[2])};
      for (std::size_t k = 0; k < 3; ++k) {
        if (v[k] == v[(k + 1) % 3]) refused[v[k]] = true;
      }
    }
    std::unordered_map<Index, Cluster> clusters;
    for (const EdgeMatch& pair : pairs) {
      const double t = tolerance_between(edges_[pair.first], edges_[pair.second], scaled_);
      for (const auto& [a, b] : pair.ends(edges_)) {
        Cluster& cluster = clusters.try_emplace(wanted.find(a), Cluster{{}, t}).first->second;
        cluster.tolerance = std::min(cluster.tolerance, t);
      }
    }
    for (Index v = 0; v < mesh_.positions.size(); ++v) {
      const auto found = clusters.find(wanted.find(v));
      if (found != clusters.end()) found->second.members.push_back(v);
    }
    for (const auto& [vertex, cluster] : clusters) {
      if (!within_tolerance(cluster)) refused[vertex] = true;
    }
    return refused;
  }

  bool within_tolerance(const Cluster& cluster) const {
    const auto& members = cluster.members;
    // Members of large clusters are not compared one by one if that can be helped.
    Vec3 low = scaled_.points[members[0]], high = low;
    for (const Index v : members) {
      low = low.cwiseMin(scaled_.points[v]);
      high = high.cwiseMax(scaled_.points[v]);
    }
    if ((high - low).norm() <= cluster.tolerance) return true;
    constexpr std::size_t kMostMembers = 1000;
    if (members.size() > kMostMembers) return false;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!scaled_.within(members[i], members[j], cluster.tolerance)) return false;
      }
    }
    return true;
  }

  void drop_merged_vertices() {
    if (report_.nothing_done()) return;
    Index count = 0;
    for (Index v = 0; v < mesh_.positions.size(); ++v) {
      if (const Index first = sets_.find(v); first != v) {
        report_.vertex[v] = report_.vertex[first];
        continue;
      }
      mesh_.positions[count] = mesh_.positions[v];
      report_.vertex[v] = count++;
    }
    mesh_.positions.resize(count);
    for (auto& face : mesh_.faces) {
      for (Index& v : face) v = report_.vertex[v];
    }
  }

  TriangleMesh mesh_;
  JoinReport& report_;
  const ScaledPoints scaled_;
  DisjointSets sets_;                // of vertices that are one
  std::vector<bool> left_apart_;     // per vertex: would have been in a chain
  std::vector<BoundaryEdge> edges_;  // of the mesh as it is now
};

}  // namespace

ScaledPoints::ScaledPoints(const TriangleMesh& mesh, std::optional<double> given)
    : points(mesh.positions) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  constexpr int kMostExponent = 1000;
  const int exponent =
      largest > 0 ? std::clamp(std::ilogb(largest), -kMostExponent, kMostExponent) : 0;
  const double scale = std::ldexp(1.0, -exponent);
  tolerance.reserve(points.size());
  for (Vec3& p : points) {
    tolerance.push_back((given ? *given : kSteps * mesh.precision.step_at(p)) * scale);
    largest_tolerance = std::max(largest_tolerance, tolerance.back());
    p *= scale;
  }
}

TriangleMesh join_boundaries(const TriangleMesh& mesh, std::optional<double> tolerance,
                             JoinReport* report) {
  JoinReport local;
  JoinReport& r = report != nullptr ? *report : local;
  r = {};
  r.vertex.resize(mesh.positions.size());
  r.face.resize(mesh.faces.size());
  std::iota(r.vertex.begin(), r.vertex.end(), Index{0});
  std::iota(r.face.begin(), r.face.end(), Index{0});
  if (tolerance && !(*tolerance > 0)) return mesh;
  return BoundaryJoin(mesh, tolerance, r).run();
}

}  // namespace onmesh
