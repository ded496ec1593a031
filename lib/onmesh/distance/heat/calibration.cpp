#include "onmesh/distance/heat/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onmesh/distance/distance_table.h"

namespace onmesh::heat {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Calibration::Calibration(const Patch& near, const Reach& reach)
    : nodes_(Index(near.nodes.size())),
      share_(kNearShare * reach.radius),
      near_reach_(std::min(reach.table, std::max(2 * near.longest_edge, share_))),
      limit_(reach.table + near.longest_edge / 2),
      offsets_(near.nodes.size() + 1, 0),
      distance_(near.nodes.size(), kInfinity),
      correction_(near.nodes.size(), 0) {
  for (const auto& c : near.corners)
    for (const Index v : c) ++offsets_[v + 1];
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  steps_.resize(offsets_.back());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (Index f = 0; f < near.corners.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const auto& c = near.corners[f];
      const auto& l = near.lengths[f];
      Step step{c[a], c[b], l[a], 0, 0, 0, l[k], l[b]};
      if (step.edge > 0) {
        step.half_inverse = 1 / (2 * step.edge);
        step.x = (step.edge * step.edge + (step.to_i - step.to_j) * (step.to_i + step.to_j)) *
                 step.half_inverse;
        step.y = std::sqrt(std::max(0.0, (step.to_i - step.x) * (step.to_i + step.x)));
      }
      steps_[next[c[k]]++] = step;
    }
}

// The near field's nodes: at most two edges from the source, or within its share of the kernel.
void Calibration::mark_near(Index source, const float* row) {
  near_.assign(1, source);
  distance_[source] = 0;
  const auto add = [&](Index node) {
    if (distance_[node] < kInfinity || row[node] == kUnreachable) return;
    distance_[node] = std::sqrt(double(row[node]));
    near_.push_back(node);
  };
  std::size_t begin = 0;
  for (int ring = 0; ring < 2; ++ring)
    for (const std::size_t end = near_.size(); begin < end; ++begin)
      for (Index s = offsets_[near_[begin]]; s < offsets_[near_[begin] + 1]; ++s) {
        add(steps_[s].i);
        add(steps_[s].j);
      }
  const double squared = share_ * share_;
  for (Index node = 0; node < nodes_; ++node)
    if (row[node] <= squared) add(node);
}

// The correction at a node from those around it that are known.
double Calibration::carry_on(Index node) const {
  double best = kInfinity, correction = mean_;  // best: a square
  const auto along = [&](Index from, double length) {
    const double there = (distance_[from] + length) * (distance_[from] + length);
    if (!(there < best)) return;
    best = there;
    correction = correction_[from];
  };
  for (Index s = offsets_[node]; s < offsets_[node + 1]; ++s) {
    const Step& step = steps_[s];
    const double di = distance_[step.i], dj = distance_[step.j];
    along(step.i, step.to_i);
    along(step.j, step.to_j);
    if (!(di < kInfinity && dj < kInfinity && step.edge > 0)) continue;
    // The source at (x, -y).
    const double x = (di - dj) * (di + dj) * step.half_inverse + step.edge / 2;
    const double y2 = (di - x) * (di + x);
    if (!(y2 >= 0)) continue;
    const double y = std::sqrt(y2), height = y + step.y;
    const double crossing = step.x * y + x * step.y;
    if (!(crossing >= 0 && crossing <= step.edge * height && height > 0)) continue;
    const double there = (step.x - x) * (step.x - x) + height * height;
    if (!(there < best)) continue;
    best = there;
    const double share = crossing / (step.edge * height);
    correction = (1 - share) * correction_[step.i] + share * correction_[step.j];
  }
  return correction;
}

void Calibration::complete(Index source, const std::vector<double>& phi, float* row) {
  mark_near(source, row);
  double sum = 0;
  for (const Index node : near_) {
    correction_[node] = distance_[node] - phi[node];
    if (node != source) sum += correction_[node];
  }
  mean_ = near_.size() > 1 ? sum / double(near_.size() - 1) : -phi[source];

  far_.clear();
  for (Index node = 0; node < nodes_; ++node) {
    if (distance_[node] < kInfinity) continue;
    row[node] = kUnreachable;
    // Corrections are far smaller than what the limit leaves beyond the reach.
    if (phi[node] + mean_ <= limit_) far_.push_back(node);
  }
  std::sort(far_.begin(), far_.end(),
            [&](Index a, Index b) { return std::pair(phi[a], a) < std::pair(phi[b], b); });
  for (const Index node : far_) {
    correction_[node] = carry_on(node);
    distance_[node] = std::max(0.0, phi[node] + correction_[node]);
    if (distance_[node] <= limit_) row[node] = float(distance_[node] * distance_[node]);
  }
  for (const Index node : near_) distance_[node] = kInfinity;
  for (const Index node : far_) distance_[node] = kInfinity;
}

}  // namespace onmesh::heat
