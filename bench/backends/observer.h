// Watches a back end fill the filter's tables: what it returns, how long that takes, how much
// memory.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "backends/scene.h"
#include "onmesh/distance/backend.h"

namespace onmesh::bench {

/// True distances between the corners of the node faces that the tried texels lie in and all nodes
/// within the radius: per tried texel and corner.
using NodeTruth = std::vector<std::array<std::vector<std::pair<Index, double>>, 3>>;

/// Of filling tables; NaN = not measured.
struct Cost {
  /// Per source: all of it, and the share of what is done per patch whatever the number of sources.
  /// The latter is NaN where all patches have few sources.
  double us_per_source = std::numeric_limits<double>::quiet_NaN();
  double prepare_us = std::numeric_limits<double>::quiet_NaN();
  double memory_mb = std::numeric_limits<double>::quiet_NaN();  ///< of the patch that takes most
};

/// Hands fill() on to a back end, and looks at every table that the filter gets. Patches without a
/// tried texel are left out (on a large mesh, most), the others are exactly the filter's.
///
/// \param repeats runs per time; 0 = no times, and patches may be filled in parallel
class Observer final : public DistanceBackend {
 public:
  Observer(const Scene& scene, const DistanceBackend& backend, int repeats);
  /// Compare the tables' own entries with these.
  void expect(const NodeTruth& truth) {
    node_truth_ = &truth;
    node_distances_.resize(truth.size());
  }
  /// Keep the tables' own entries up to this distance as the truth.
  void record(double radius, NodeTruth& truth);

  std::string_view name() const override { return backend_.name(); }
  double margin(double reach, double longest_edge) const override {
    return backend_.margin(reach, longest_edge);
  }
  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override;

  /// Per tried texel, as in its neighbourhood; NaN = unreachable.
  const std::vector<std::vector<double>>& distances() const { return distances_; }
  /// Per tried texel, in the order of its truth.
  const std::vector<std::vector<double>>& node_distances() const { return node_distances_; }
  /// \pre repeats > 0
  Cost cost() const;

 private:
  /// Precomputation is what a table of few rows costs, less those rows.
  void measure(const Patch& patch, const Reach& reach, DistanceTable& table) const;

  void look_up(const Patch& patch, const DistanceTable& table) const;

  std::vector<double> distances_of(std::size_t k, const Patch& patch, const DistanceTable& table,
                                   Index f, const std::vector<Index>& local_face) const;

  void compare_nodes(std::size_t k, const Patch& patch, const DistanceTable& table, Index f,
                     const std::vector<Index>& local_node) const;

  void record_nodes(std::size_t k, const Patch& patch, const DistanceTable& table, Index f) const;

  const NodePoint& place(std::size_t point) const {
    return scene_.places[scene_.points.texels[point]];
  }

  const Scene& scene_;
  const DistanceBackend& backend_;
  const int repeats_;
  const NodeTruth* node_truth_ = nullptr;
  NodeTruth* recorded_ = nullptr;
  double record_radius_ = 0;
  // Every tried texel is in one core face of one patch, so patches write to places of their own.
  mutable std::vector<std::vector<double>> distances_, node_distances_;
  std::vector<std::vector<std::size_t>> tried_in_face_;
  mutable double seconds_ = 0, few_seconds_ = 0, rows_ = 0, few_rows_ = 0;
  mutable double memory_ = std::numeric_limits<double>::quiet_NaN();  ///< none known yet
};

}  // namespace onmesh::bench
