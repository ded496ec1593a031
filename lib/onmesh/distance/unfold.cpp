#include "onmesh/distance/unfold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "onmesh/base/simd_targets.h"
#include "onmesh/base/triangle.h"
#include "onmesh/distance/march_queue.h"
#include "onmesh/distance/unfold_complex.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/distance/unfold.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef ONMESH_UNFOLD_ONCE_
#define ONMESH_UNFOLD_ONCE_
namespace onmesh::unfold {

// Squared distance of a node that no path has reached. Lengths are scaled to about 1, and the
// square still fits a float.
constexpr float kFar = 1e30F;

template <class T>
struct Scratch {
  explicit Scratch(std::size_t nodes)
      : squared(nodes * kLanes, T(kFar)), is_touched(nodes, 0), quick(nodes), nearest(nodes) {}

  void touch(Index node) {
    if (is_touched[node]) return;
    is_touched[node] = 1;
    touched.push_back(node);
  }

  std::vector<T> squared;      // nodes x kLanes
  std::vector<Index> touched;  // nodes that differ from kFar
  std::vector<unsigned char> is_touched;
  FirstInFirstOut<T> quick;
  NearestFirst<T> nearest;
};

// What a step did to its target in any lane.
template <class T>
struct Change {
  bool any = false;
  bool passes_on = false;  // enough to tell the target's neighbours
  T nearest = T(kFar);     // squared, of the lanes that pass on; if it is wanted
};

}  // namespace onmesh::unfold
#endif

HWY_BEFORE_NAMESPACE();
namespace onmesh::unfold::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One step in all lanes: the virtual source of each, from the squared distances at v and at
// `other`, and the way from it to the target.
// \param root the distances at v
// \param limit2 squared: a target farther away tells no neighbour
// \param significant what an improvement leaves at most, to be passed on
// \tparam by_distance whether Change::nearest is wanted
template <bool by_distance, class T>
HWY_INLINE Change<T> take(const Step<T>& step, const T* at_v, const T* root, T limit2,
                          T significant, T* squared) {
  const hn::CappedTag<T, kLanes> d;
  const auto zero = hn::Zero(d), two = hn::Set(d, T(2)), far = hn::Set(d, T(kFar));
  const auto reached = hn::Set(d, T(kFar) / 2);  // whatever follows from kFar is more
  const auto tolerance = hn::Set(d, sizeof(T) == 4 ? T(-1e-5) : T(-1e-11));
  const T* const at_other = squared + std::size_t(step.other) * kLanes;
  T* const at_target = squared + std::size_t(step.target) * kLanes;
  const auto l = hn::Set(d, step.edge), half = hn::Set(d, step.half_edge);
  const auto half_inverse = hn::Set(d, step.half_inverse), side = hn::Set(d, step.side);
  const auto x = hn::Set(d, step.x), y = hn::Set(d, step.y), side2 = hn::Set(d, step.side2);
  const auto floor = hn::Mul(tolerance, hn::Mul(l, l));
  Change<T> change;
  for (std::size_t p = 0; p < kLanes; p += hn::Lanes(d)) {
    const auto dv = hn::LoadU(d, at_v + p), dj = hn::LoadU(d, at_other + p);
    const auto old = hn::LoadU(d, at_target + p);
    // The source at (sx, -sy): |source v|^2 = dv, |source other|^2 = dj.
    const auto sx = hn::MulAdd(hn::Sub(dv, dj), half_inverse, half);
    const auto sy2 = hn::NegMulAdd(sx, sx, dv);
    const auto sy = hn::Sqrt(hn::Max(sy2, zero));
    // Its ray to the target meets the edge at x = crossing / (y + sy).
    const auto crossing = hn::MulAdd(x, sy, hn::Mul(sx, y));
    const auto straight =
        hn::And(hn::And(hn::Ge(crossing, zero), hn::Le(crossing, hn::Mul(l, hn::Add(y, sy)))),
                hn::Ge(sy2, hn::MulAdd(tolerance, dv, floor)));
    const auto unfolded = hn::MulAdd(two, hn::NegMulAdd(sx, x, hn::Mul(sy, y)), hn::Add(dv, side2));
    const auto along = hn::Add(hn::LoadU(d, root + p), side);
    // Not below 0: the way back to the source would be an improvement for ever.
    const auto there =
        hn::Max(hn::Min(hn::Mul(along, along), hn::IfThenElse(straight, unfolded, far)), zero);
    const auto better = hn::Lt(there, hn::Min(old, reached));
    if (hn::AllFalse(d, better)) continue;
    change.any = true;
    hn::StoreU(hn::IfThenElse(better, there, old), d, at_target + p);
    const auto tells = hn::And(hn::Lt(there, hn::Mul(old, hn::Set(d, significant))),
                               hn::Le(there, hn::Set(d, limit2)));
    if (hn::AllFalse(d, tells)) continue;
    change.passes_on = true;
    if constexpr (by_distance) {
      const auto nearest = hn::MinOfLanes(d, hn::IfThenElse(tells, there, far));
      change.nearest = std::min(change.nearest, hn::GetLane(nearest));
    }
  }
  return change;
}

// Go on from queued nodes, as far as the reach and the complex's limits say, until none is left or
// nodes were visited so many times on average.
// \param noise smaller relative improvements are kept, but not passed on: rounding must not keep
//   the march busy. Where edges are so short that it does, more and more counts as noise.
template <class T, class Queue>
void march_on(const Complex<T>& complex, T reach, double most_visits, T noise, Scratch<T>& s,
              Queue& queue) {
  const hn::CappedTag<T, kLanes> d;
  const std::size_t nodes = s.is_touched.size();
  std::size_t visits = 0, patience = 64 * nodes;
  alignas(64) std::array<T, kLanes> root;
  while (double(visits) < most_visits * double(s.touched.size())) {
    const std::optional<Index> next = queue.pop();
    if (!next) return;
    if (++visits > patience) {
      patience += nodes;
      noise = std::min(T(1), 2 * noise);
    }
    const T* const at_v = s.squared.data() + std::size_t(*next) * kLanes;
    for (std::size_t p = 0; p < kLanes; p += hn::Lanes(d))
      hn::Store(hn::Sqrt(hn::LoadU(d, at_v + p)), d, root.data() + p);

    for (Index i = complex.offsets[*next]; i < complex.offsets[*next + 1]; ++i) {
      const Step<T>& step = complex.steps[i];
      const T beyond = reach + complex.limit[step.target];
      const Change<T> change = take<Queue::kByDistance>(step, at_v, root.data(), beyond * beyond,
                                                        1 - noise, s.squared.data());
      if (change.any) s.touch(step.target);
      if (change.passes_on) queue.push(step.target, change.nearest);
    }
  }
}

// From up to kLanes sources, one per lane.
// \param reach of all sources, in the complex's unit
template <class T>
void march(const Complex<T>& complex, const Index* sources, std::size_t count, T reach, T noise,
           Scratch<T>& s) {
  for (std::size_t lane = 0; lane < count; ++lane) {
    s.squared[std::size_t(sources[lane]) * kLanes + lane] = 0;
    s.touch(sources[lane]);
    s.quick.push(sources[lane], 0);
  }
  // Elsewhere than beside needles it visits a node two to six times.
  constexpr double kQuickVisits = 8;
  march_on(complex, reach, kQuickVisits, noise, s, s.quick);
  while (const std::optional<Index> node = s.quick.pop()) {
    const T* const at = s.squared.data() + std::size_t(*node) * kLanes;
    s.nearest.push(*node, *std::min_element(at, at + kLanes));
  }
  march_on(complex, reach, std::numeric_limits<double>::infinity(), noise, s, s.nearest);
}

void march_float(const Complex<float>& complex, const Index* sources, std::size_t count,
                 float reach, float noise, Scratch<float>& scratch) {
  march(complex, sources, count, reach, noise, scratch);
}
void march_double(const Complex<double>& complex, const Index* sources, std::size_t count,
                  double reach, double noise, Scratch<double>& scratch) {
  march(complex, sources, count, reach, noise, scratch);
}

}  // namespace onmesh::unfold::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
namespace unfold {

HWY_EXPORT(march_float);
HWY_EXPORT(march_double);

namespace {

void march(const Complex<float>& complex, const Index* sources, std::size_t count, float reach,
           float noise, Scratch<float>& scratch) {
  HWY_DYNAMIC_DISPATCH(march_float)(complex, sources, count, reach, noise, scratch);
}
void march(const Complex<double>& complex, const Index* sources, std::size_t count, double reach,
           double noise, Scratch<double>& scratch) {
  HWY_DYNAMIC_DISPATCH(march_double)(complex, sources, count, reach, noise, scratch);
}

template <class T>
void fill_table(const Patch& patch, const Incidence& around, double reach, double scale,
                double slack, double noise, DistanceTable& table) {
  const Complex<T> complex = make_complex<T>(patch, around, scale, slack);
  const std::vector<Index> order = order_sources(patch, around, kLanes);
  const std::size_t nodes = patch.nodes.size();
  Scratch<T> scratch(nodes);

  const double scale2 = scale * scale;
  for (std::size_t begin = 0; begin < order.size(); begin += kLanes) {
    const std::size_t count = std::min(kLanes, order.size() - begin);
    double extent = 0;
    for (std::size_t lane = 0; lane < count && !patch.extents.empty(); ++lane)
      extent = std::max(extent, patch.extents[order[begin + lane]]);
    march(complex, order.data() + begin, count, T((reach + extent) / scale), T(noise), scratch);
    for (const Index node : scratch.touched) {
      T* const at = scratch.squared.data() + std::size_t(node) * kLanes;
      for (std::size_t lane = 0; lane < count; ++lane)
        if (at[lane] < T(kFar))
          table.squared[std::size_t(order[begin + lane]) * nodes + node] = float(at[lane] * scale2);
      std::fill_n(at, kLanes, T(kFar));
      scratch.is_touched[node] = 0;
    }
    scratch.touched.clear();
  }
}

class Unfold final : public DistanceBackend {
 public:
  std::string_view name() const override { return "unfold"; }
  bool knows_extents() const override { return true; }

  // A path no longer than `reach` stays within reach; the triangles it crosses have corners at most
  // an edge beyond.
  double margin(double, double longest_edge) const override { return longest_edge; }

  void fill(const Patch& patch, const Reach& reach, DistanceTable& table) const override {
    table.rows = patch.core_nodes;
    table.columns = Index(patch.nodes.size());
    table.squared.assign(std::size_t(table.rows) * table.columns, kUnreachable);
    const Incidence around(patch);
    // Float is enough for well-shaped faces, and nodes more than an edge beyond reach tell those
    // within nothing. Slivers multiply rounding by their aspect at every step, and see farther.
    double worst = 1;
    for (std::size_t f = 0; f + patch.bridge_faces < patch.lengths.size(); ++f) {
      const auto& l = patch.lengths[f];
      const double longest = std::max({l[0], l[1], l[2]});
      worst = std::max(worst, longest * longest / (2 * triangle_area(l[0], l[1], l[2])));
    }
    const double scale = patch.longest_edge > 0 ? patch.longest_edge : 1;
    if (worst < 8)
      fill_table<float>(patch, around, reach.table, scale, 1, 1e-6, table);
    else
      fill_table<double>(patch, around, reach.table, scale, 2,
                         std::clamp(1e-14 * worst, 1e-12, 1e-5), table);
  }
};

}  // namespace
}  // namespace unfold

std::unique_ptr<DistanceBackend> make_unfold() { return std::make_unique<unfold::Unfold>(); }

}  // namespace onmesh
#endif  // HWY_ONCE
