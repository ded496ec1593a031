#include "onmesh/patches/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace onmesh {
namespace {

// So many faces make a cluster, and so small a share of a group.
constexpr std::size_t kClusterFaces = 8;
constexpr double kClusterShare = 1.0 / 24;

// Clusters of faces that share nodes, with the incidence of clusters and nodes (CSR, both ways).
struct Clusters {
  std::vector<std::vector<Index>> faces;
  std::vector<double> weights;
  std::vector<Index> node_begin, nodes;        // per cluster
  std::vector<Index> cluster_begin, clusters;  // per node
  Index size() const { return Index(faces.size()); }
};

Clusters make_clusters(const NodeMesh& mesh, const std::vector<double>& weights,
                       double largest_weight) {
  Clusters result;
  std::vector<bool> taken(mesh.faces.size(), false);
  for (Index start = 0; start < mesh.faces.size(); ++start) {
    if (taken[start] || !(weights[start] > 0)) continue;
    std::vector<Index> cluster{start};
    taken[start] = true;
    double weight = weights[start];
    for (std::size_t next = 0; next < cluster.size(); ++next) {
      for (const Index v : mesh.faces[cluster[next]]) {
        for (Index i = mesh.node_offsets[v]; i < mesh.node_offsets[v + 1]; ++i) {
          const Index f = mesh.node_faces[i];
          if (cluster.size() >= kClusterFaces || taken[f] || !(weights[f] > 0) ||
              weight + weights[f] > largest_weight)
            continue;
          taken[f] = true;
          weight += weights[f];
          cluster.push_back(f);
        }
      }
    }
    result.faces.push_back(std::move(cluster));
    result.weights.push_back(weight);
  }

  result.node_begin.push_back(0);
  result.cluster_begin.assign(mesh.nodes.size() + 1, 0);
  std::vector<Index> own;
  for (const auto& cluster : result.faces) {
    own.clear();
    for (const Index f : cluster) own.insert(own.end(), mesh.faces[f].begin(), mesh.faces[f].end());
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    for (const Index v : own) ++result.cluster_begin[v + 1];
    result.nodes.insert(result.nodes.end(), own.begin(), own.end());
    result.node_begin.push_back(Index(result.nodes.size()));
  }
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    result.cluster_begin[v + 1] += result.cluster_begin[v];
  result.clusters.resize(result.nodes.size());
  std::vector<Index> next(result.cluster_begin.begin(), result.cluster_begin.end() - 1);
  for (Index c = 0; c < result.size(); ++c)
    for (Index i = result.node_begin[c]; i < result.node_begin[c + 1]; ++i)
      result.clusters[next[result.nodes[i]]++] = c;
  return result;
}

// Breadth-first searches over clusters that share nodes, within those of one label at a time.
class ClusterSearch {
 public:
  explicit ClusterSearch(const Clusters& clusters)
      : label(clusters.size(), 0),
        clusters_(clusters),
        cluster_seen_(clusters.size(), 0),
        node_seen_(clusters.cluster_begin.size(), 0) {}

  // Forget which clusters and nodes were visited.
  void restart() { ++epoch_; }
  bool seen(Index cluster) const { return cluster_seen_[cluster] == epoch_; }

  // The clusters reached from `start` within its label, nearest first; hops[cluster] if asked for.
  std::vector<Index> reach(Index start, std::vector<int>* hops = nullptr) {
    std::vector<Index> order{start};
    cluster_seen_[start] = epoch_;
    if (hops) (*hops)[start] = 0;
    for (std::size_t next = 0; next < order.size(); ++next) {
      const Index c = order[next];
      for (Index k = clusters_.node_begin[c]; k < clusters_.node_begin[c + 1]; ++k) {
        const Index v = clusters_.nodes[k];
        if (node_seen_[v] == epoch_) continue;
        node_seen_[v] = epoch_;
        for (Index i = clusters_.cluster_begin[v]; i < clusters_.cluster_begin[v + 1]; ++i) {
          const Index g = clusters_.clusters[i];
          if (cluster_seen_[g] == epoch_ || label[g] != label[start]) continue;
          cluster_seen_[g] = epoch_;
          if (hops) (*hops)[g] = (*hops)[c] + 1;
          order.push_back(g);
        }
      }
    }
    return order;
  }

  std::vector<Index> label;  // per cluster

 private:
  const Clusters& clusters_;
  std::vector<Index> cluster_seen_, node_seen_;
  Index epoch_ = 0;
};

// Order a connected set of clusters from one far end to the other by the difference of the hop
// distances to both ends: the cut through the middle is then short and straight.
std::vector<Index> order_between_ends(ClusterSearch& search, Index start,
                                      std::vector<int>& to_first, std::vector<int>& to_last) {
  search.restart();
  const Index first = search.reach(start).back();
  search.restart();
  const std::vector<Index> order = search.reach(first, &to_first);
  search.restart();
  search.reach(order.back(), &to_last);

  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (const Index c : order) {
    lowest = std::min(lowest, to_first[c] - to_last[c]);
    highest = std::max(highest, to_first[c] - to_last[c]);
  }
  std::vector<std::size_t> begin(highest - lowest + 2, 0);
  for (const Index c : order) ++begin[to_first[c] - to_last[c] - lowest + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Index> sorted(order.size());
  for (const Index c : order) sorted[begin[to_first[c] - to_last[c] - lowest]++] = c;
  return sorted;
}

// Groups of clusters of about `target_weight`.
std::vector<std::vector<Index>> bisect(const Clusters& clusters, double target_weight) {
  ClusterSearch search(clusters);
  std::vector<int> to_first(clusters.size()), to_last(clusters.size());
  std::vector<std::vector<Index>> groups, pending;
  Index labels = 1;
  // Split clusters of one label into connected pieces.
  const auto split = [&](std::vector<Index>& part) {
    std::sort(part.begin(), part.end());
    search.restart();
    const std::size_t before = pending.size();
    for (const Index c : part)
      if (!search.seen(c)) pending.push_back(search.reach(c));
    for (std::size_t i = before; i < pending.size(); ++i, ++labels)
      for (const Index c : pending[i]) search.label[c] = labels;
    std::reverse(pending.begin() + std::ptrdiff_t(before), pending.end());
  };
  std::vector<Index> all(clusters.size());
  for (Index c = 0; c < clusters.size(); ++c) all[c] = c;
  split(all);

  while (!pending.empty()) {
    std::vector<Index> piece = std::move(pending.back());
    pending.pop_back();
    double total = 0;
    for (const Index c : piece) total += clusters.weights[c];
    if (total <= 1.25 * target_weight || piece.size() == 1) {
      groups.push_back(std::move(piece));
      continue;
    }
    // Cut off the share that makes a whole number of groups on both sides.
    const double parts = std::max(2.0, std::round(total / target_weight));
    const double wanted = total * std::floor(parts / 2) / parts;
    const std::vector<Index> order = order_between_ends(search, piece.front(), to_first, to_last);
    std::size_t cut = 0;
    for (double sum = 0;
         cut + 1 < order.size() && (cut == 0 || sum + clusters.weights[order[cut]] <= wanted);)
      sum += clusters.weights[order[cut++]];
    std::vector<Index> near(order.begin(), order.begin() + std::ptrdiff_t(cut)),
        far(order.begin() + std::ptrdiff_t(cut), order.end());
    for (const Index c : near) search.label[c] = labels;
    ++labels;
    split(far);
    split(near);
  }
  return groups;
}

// Merge groups below a quarter of the target into their lightest neighbour.
void merge_small(const NodeMesh& mesh, const std::vector<double>& weights, double target,
                 std::vector<std::vector<Index>>& groups, std::vector<Index>& group_of) {
  std::vector<double> total(groups.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const Index f : groups[g]) total[g] += weights[f];
  for (Index g = 0; g < groups.size(); ++g) {
    if (total[g] >= 0.25 * target) continue;
    Index best = kNone;
    for (const Index f : groups[g])
      for (const Index v : mesh.faces[f])
        for (Index i = mesh.node_offsets[v]; i < mesh.node_offsets[v + 1]; ++i) {
          const Index other = group_of[mesh.node_faces[i]];
          if (other == kNone || other == g || total[g] + total[other] > 1.5 * target) continue;
          if (best == kNone || std::pair(total[other], other) < std::pair(total[best], best))
            best = other;
        }
    if (best == kNone) continue;
    for (const Index f : groups[g]) group_of[f] = best;
    groups[best].insert(groups[best].end(), groups[g].begin(), groups[g].end());
    groups[g].clear();
    total[best] += std::exchange(total[g], 0);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
}

}  // namespace

std::vector<std::vector<Index>> partition_faces(const NodeMesh& mesh,
                                                const std::vector<double>& weights,
                                                double target_weight) {
  const Clusters clusters = make_clusters(mesh, weights, kClusterShare * target_weight);
  std::vector<std::vector<Index>> groups = bisect(clusters, target_weight);
  std::vector<Index> group_of(mesh.faces.size(), kNone);
  for (Index g = 0; g < groups.size(); ++g) {
    std::vector<Index> faces;
    for (const Index c : groups[g])
      faces.insert(faces.end(), clusters.faces[c].begin(), clusters.faces[c].end());
    for (const Index f : faces) group_of[f] = g;
    groups[g] = std::move(faces);
  }
  merge_small(mesh, weights, target_weight, groups, group_of);
  for (auto& group : groups) std::sort(group.begin(), group.end());
  return groups;
}

std::vector<std::vector<Index>> split_core(const Patch& patch) {
  NodeMesh core;
  core.nodes.resize(patch.core_nodes);
  core.faces.assign(patch.corners.begin(), patch.corners.begin() + patch.core_faces);
  core.build_incidence();
  std::vector<std::vector<Index>> groups = partition_faces(
      core, std::vector<double>(patch.core_faces, 1), 0.5 * double(patch.core_faces));
  for (std::vector<Index>& group : groups) {
    for (Index& face : group) face = patch.faces[face];
    std::sort(group.begin(), group.end());
  }
  return groups;
}

}  // namespace onmesh
