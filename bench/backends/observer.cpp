#include "backends/observer.h"

#include <algorithm>
#include <cmath>

#include "numbers.h"
#include "onmesh/base/process_memory.h"

namespace onmesh::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Observer::Observer(const Scene& scene, const DistanceBackend& backend, int repeats)
    : scene_(scene),
      backend_(backend),
      repeats_(repeats),
      distances_(scene.tried.size()),
      tried_in_face_(scene.surface.nodes.faces.size()) {
  for (std::size_t k = 0; k < scene.tried.size(); ++k) {
    const Index texel = scene.points.texels[scene.tried[k].centre];
    tried_in_face_[scene.places[texel].face].push_back(k);
  }
}

void Observer::record(double radius, NodeTruth& truth) {
  truth.assign(scene_.tried.size(), {});
  recorded_ = &truth;
  record_radius_ = radius;
}

void Observer::fill(const Patch& patch, const Reach& reach, DistanceTable& table) const {
  if (std::all_of(patch.faces.begin(), patch.faces.begin() + patch.core_faces,
                  [this](Index f) { return tried_in_face_[f].empty(); })) {
    table.rows = patch.core_nodes;
    table.columns = Index(patch.nodes.size());
    table.squared.assign(std::size_t(table.rows) * table.columns, kUnreachable);
    return;
  }
  if (repeats_ > 0) {
    measure(patch, reach, table);
  } else {
    backend_.fill(patch, reach, table);
  }
  look_up(patch, table);
}

void Observer::measure(const Patch& patch, const Reach& reach, DistanceTable& table) const {
  constexpr Index kFewRows = 16;  // what back ends work on at a time
  Patch small = patch;
  small.core_nodes = std::min(kFewRows, patch.core_nodes);
  table = {};
  const MemoryMeter memory;
  backend_.fill(patch, reach, table);
  if (const auto peak = memory.peak())
    memory_ = std::fmax(memory_, std::max(0.0, double(*peak) - double(memory.before())));
  std::vector<double> full, few;
  for (int i = 0; i < repeats_; ++i) {
    DistanceTable unused;
    const double start = thread_seconds();
    backend_.fill(small, reach, unused);
    const double middle = thread_seconds();
    backend_.fill(patch, reach, table);
    few.push_back(middle - start);
    full.push_back(thread_seconds() - middle);
  }
  seconds_ += median(full);
  few_seconds_ += median(few);
  rows_ += patch.core_nodes;
  few_rows_ += small.core_nodes;
}

void Observer::look_up(const Patch& patch, const DistanceTable& table) const {
  std::vector<Index> face(scene_.surface.nodes.faces.size(), kNone);
  std::vector<Index> node(scene_.surface.nodes.nodes.size(), kNone);
  for (Index f = 0; f < patch.faces.size(); ++f) face[patch.faces[f]] = f;
  for (Index n = 0; n < patch.nodes.size(); ++n) node[patch.nodes[n]] = n;
  for (Index f = 0; f < patch.core_faces; ++f) {
    for (const std::size_t k : tried_in_face_[patch.faces[f]]) {
      distances_[k] = distances_of(k, patch, table, f, face);
      if (node_truth_ != nullptr) compare_nodes(k, patch, table, f, node);
      if (recorded_ != nullptr) record_nodes(k, patch, table, f);
    }
  }
}

std::vector<double> Observer::distances_of(std::size_t k, const Patch& patch,
                                           const DistanceTable& table, Index f,
                                           const std::vector<Index>& local_face) const {
  const Neighbourhood& around = scene_.tried[k];
  const Vec3 a = place(around.centre).barycentric;
  const double variance = barycentric_variance(patch.lengths[f], a);
  std::vector<double> out;
  out.reserve(around.near.size());
  for (const std::size_t y : around.near) {
    const NodePoint& b = place(y);
    const Index g = b.face == kNone ? kNone : local_face[b.face];
    double squared[3][3], d2 = double(kUnreachable);
    if (g != kNone) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
          squared[i][j] = double(table.row(patch.corners[f][i])[patch.corners[g][j]]);
      }
      d2 = interpolate_squared(squared, a, b.barycentric, variance,
                               barycentric_variance(patch.lengths[g], b.barycentric));
    }
    out.push_back(d2 < double(kUnreachable) ? std::sqrt(d2) : kNaN);
  }
  return out;
}

void Observer::compare_nodes(std::size_t k, const Patch& patch, const DistanceTable& table, Index f,
                             const std::vector<Index>& local_node) const {
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& [node, d] : (*node_truth_)[k][i]) {
      const Index n = local_node[node];
      const float d2 = n == kNone ? kUnreachable : table.row(patch.corners[f][i])[n];
      node_distances_[k].push_back(d2 < kUnreachable ? std::sqrt(double(d2)) : kNaN);
    }
  }
}

void Observer::record_nodes(std::size_t k, const Patch& patch, const DistanceTable& table,
                            Index f) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const float* row = table.row(patch.corners[f][i]);
    for (Index n = 0; n < patch.nodes.size(); ++n) {
      if (double(row[n]) <= record_radius_ * record_radius_)
        (*recorded_)[k][i].emplace_back(patch.nodes[n], std::sqrt(double(row[n])));
    }
  }
}

Cost Observer::cost() const {
  Cost cost;
  cost.us_per_source = 1e6 * seconds_ / rows_;
  if (rows_ > few_rows_) {
    const double fill = std::max(0.0, (seconds_ - few_seconds_) / (rows_ - few_rows_));
    cost.prepare_us = 1e6 * std::max(0.0, seconds_ / rows_ - fill);
  }
  cost.memory_mb = 1e-6 * memory_;
  return cost;
}

}  // namespace onmesh::bench
