#include "onmesh/distance/heat/heat.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/simd_targets.h"
#include "onmesh/distance/heat/bridges.h"
#include "onmesh/distance/heat/calibration.h"
#include "onmesh/distance/heat/linear_systems.h"
#include "onmesh/distance/unfold.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/distance/heat/heat.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace onmesh::heat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// x := A^-1 x for kLanes right-hand sides; x[i * kLanes + lane]. Forward substitution changes only
// `rows` (ascending): all, or those that the right-hand side's entries reach in the elimination
// tree.
void solve(const Factor& factor, const std::vector<Index>& rows, float* x) {
  const hn::CappedTag<float, kLanes> d;
  const std::size_t lanes = hn::Lanes(d);
  // x_i := scale x_i - sum_k value_k x_k.
  const auto substitute = [&](Index i, float scale, Index begin, Index end, const Index* index,
                              const float* value) {
    for (std::size_t p = 0; p < kLanes; p += lanes) {
      float* const at = x + std::size_t(i) * kLanes + p;
      auto a = hn::Mul(hn::LoadU(d, at), hn::Set(d, scale)), b = hn::Zero(d);
      Index k = begin;
      for (; k + 1 < end; k += 2) {
        a = hn::NegMulAdd(hn::Set(d, value[k]),
                          hn::LoadU(d, x + std::size_t(index[k]) * kLanes + p), a);
        b = hn::NegMulAdd(hn::Set(d, value[k + 1]),
                          hn::LoadU(d, x + std::size_t(index[k + 1]) * kLanes + p), b);
      }
      if (k < end)
        a = hn::NegMulAdd(hn::Set(d, value[k]),
                          hn::LoadU(d, x + std::size_t(index[k]) * kLanes + p), a);
      hn::StoreU(hn::Add(a, b), d, at);
    }
  };
  for (const Index i : rows)
    substitute(i, 1, factor.row_begin[i], factor.row_begin[i + 1], factor.row_index.data(),
               factor.row_value.data());
  for (Index i = Index(factor.inverse_d.size()); i-- > 0;)
    substitute(i, factor.inverse_d[i], factor.column_begin[i], factor.column_begin[i + 1],
               factor.column_index.data(), factor.column_value.data());
}

// out += weight times the integrated divergence of -grad u / |grad u|.
void divergence(const std::vector<SplitFace>& faces, const float* u, float weight, float* out) {
  const hn::CappedTag<float, kLanes> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  for (const SplitFace& f : faces) {
    const auto gx1 = hn::Set(d, f.gx1), gy1 = hn::Set(d, f.gy1), gx2 = hn::Set(d, f.gx2),
               gy2 = hn::Set(d, f.gy2), area = hn::Set(d, weight * f.area);
    const std::size_t at0 = std::size_t(f.corner[0]) * kLanes;
    const std::size_t at1 = std::size_t(f.corner[1]) * kLanes;
    const std::size_t at2 = std::size_t(f.corner[2]) * kLanes;
    for (std::size_t p = 0; p < kLanes; p += lanes) {
      const auto u0 = hn::LoadU(d, u + at0 + p);
      const auto u1 = hn::Sub(hn::LoadU(d, u + at1 + p), u0);
      const auto u2 = hn::Sub(hn::LoadU(d, u + at2 + p), u0);
      auto x = hn::MulAdd(u1, gx1, hn::Mul(u2, gx2)), y = hn::MulAdd(u1, gy1, hn::Mul(u2, gy2));
      // Heat decays exponentially: by its largest component first, or the squares underflow.
      const auto largest = hn::Max(hn::Abs(x), hn::Abs(y));
      const auto known = hn::Gt(largest, zero);
      const auto inverse = hn::Div(one, hn::IfThenElse(known, largest, one));
      x = hn::Mul(x, inverse);
      y = hn::Mul(y, inverse);
      const auto norm = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
      const auto scale = hn::IfThenElseZero(known, hn::Div(area, norm));
      x = hn::Mul(x, scale);
      y = hn::Mul(y, scale);
      // The weak form: L phi = integral of X . grad(hat_i), L positive semidefinite.
      const auto div1 = hn::Neg(hn::MulAdd(x, gx1, hn::Mul(y, gy1)));
      const auto div2 = hn::Neg(hn::MulAdd(x, gx2, hn::Mul(y, gy2)));
      const auto add = [&](std::size_t at, auto value) {
        hn::StoreU(hn::Add(hn::LoadU(d, out + at + p), value), d, out + at + p);
      };
      add(at1, div1);
      add(at2, div2);
      add(at0, hn::Neg(hn::Add(div1, div2)));
    }
  }
}

}  // namespace onmesh::heat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
namespace heat {

HWY_EXPORT(solve);
HWY_EXPORT(divergence);

namespace {

// A source's heat. Large, so that the far field stays clear of denormal numbers.
constexpr float kSourceHeat = 1e25F;

// Solves for the patch's distances from up to kLanes core nodes at a time, up to a constant each.
class Solver {
 public:
  explicit Solver(const LinearSystems& systems)
      : systems_(systems),
        heat_(std::size_t(systems.size) * kLanes),
        phi_(heat_.size()),
        all_(systems.size),
        is_marked_(systems.size, 0) {
    for (Index i = 0; i < systems.size; ++i) all_[i] = i;
  }

  void solve(Index first, Index count) {
    std::fill(phi_.begin(), phi_.end(), 0.0F);
    add_divergence(systems_.heat, first, count, 2);
    add_divergence(systems_.heat4, first, count, -1);
    HWY_DYNAMIC_DISPATCH(solve)(systems_.poisson, all_, phi_.data());
  }
  // In mesh units.
  double value(Index node, Index lane) const {
    return systems_.scale * phi_[std::size_t(systems_.split_node[node]) * kLanes + lane];
  }

 private:
  void add_divergence(const Factor& factor, Index first, Index count, float weight) {
    std::fill(heat_.begin(), heat_.end(), 0.0F);
    // The rows that sources reach: their ancestors in the elimination tree.
    rows_.clear();
    for (Index lane = 0; lane < count; ++lane) {
      Index row = systems_.split_node[first + lane];
      heat_[std::size_t(row) * kLanes + lane] = kSourceHeat;
      while (!is_marked_[row]) {
        is_marked_[row] = 1;
        rows_.push_back(row);
        if (factor.column_begin[row] == factor.column_begin[row + 1]) break;
        row = factor.column_index[factor.column_begin[row]];
      }
    }
    std::sort(rows_.begin(), rows_.end());
    for (const Index row : rows_) is_marked_[row] = 0;
    HWY_DYNAMIC_DISPATCH(solve)(factor, rows_, heat_.data());
    HWY_DYNAMIC_DISPATCH(divergence)(systems_.faces, heat_.data(), weight, phi_.data());
  }

  const LinearSystems& systems_;
  std::vector<float> heat_, phi_;
  std::vector<Index> all_, rows_;
  std::vector<unsigned char> is_marked_;
};

class Heat final : public DistanceBackend {
 public:
  std::string_view name() const override { return "heat"; }
  double margin(double, double longest_edge) const override { return heat::margin(longest_edge); }
  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override {
    if (patch.bridge_faces == 0) {
      unfolded_ += !heat::fill(patch, patch, {}, reach, table);
      return;
    }
    const Patch surface = surface_of(patch);
    unfolded_ += !heat::fill(surface, surface, {}, reach, table);
    cross_bridges(surface, patch, reach.table, table);
  }
  Index unfolded_patches() const override { return unfolded_; }

 private:
  mutable std::atomic<Index> unfolded_ = 0;
};

// The systems of faces so thin that single numbers take up all their digits have no factors.
std::optional<LinearSystems> solvable_systems(const Patch& flow, const std::vector<float>& weights,
                                              double reach) {
  try {
    return make_linear_systems(flow, weights, reach);
  } catch (const NumericError&) {
    return std::nullopt;
  }
}

}  // namespace

double margin(double longest_edge) { return 2 * longest_edge; }

bool fill(const Patch& near, const Patch& flow, const std::vector<float>& weights,
          const Reach& reach, DistanceTable& table) {
  Calibration calibration(near, reach);
  make_unfold()->fill(near, Reach::up_to(calibration.near_reach()), table);
  if (!(near.longest_edge > 0)) return true;
  const std::optional<LinearSystems> found = solvable_systems(flow, weights, reach.table);
  if (!found) {
    make_unfold()->fill(near, Reach::up_to(reach.table), table);
    return false;
  }
  const LinearSystems& systems = *found;
  Solver solver(systems);
  std::vector<double> phi(near.nodes.size());
  for (Index first = 0; first < near.core_nodes; first += Index(kLanes)) {
    const Index count = std::min(Index(kLanes), near.core_nodes - first);
    solver.solve(first, count);
    for (Index lane = 0; lane < count; ++lane) {
      const Index source = first + lane;
      for (Index node = 0; node < phi.size(); ++node)
        phi[node] = systems.component[node] == systems.component[source]
                        ? solver.value(node, lane)
                        : std::numeric_limits<double>::infinity();
      calibration.complete(source, phi, table.squared.data() + std::size_t(source) * table.columns);
    }
  }
  return true;
}

}  // namespace heat

std::unique_ptr<DistanceBackend> make_heat() { return std::make_unique<heat::Heat>(); }

}  // namespace onmesh
#endif  // HWY_ONCE
