// The virtual-source march: distances from 16 sources at a time, one per SIMD lane.
//
// Compiled once per instruction set (Highway's dispatch), then the best is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/distance/unfold.cpp"
#include <hwy/foreach_target.h>
// Above is what includes this file again, so it comes before the rest.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "onmesh/distance/backend.h"

#ifndef ONMESH_UNFOLD_SHARED
#define ONMESH_UNFOLD_SHARED
namespace onmesh::unfold {

constexpr int kLanes = 16;
// Squared distance of a node that no path has reached. Lengths are scaled to about 1, and the
// square still fits a float.
constexpr float kFar = 1e30F;

// What a change at a node v does to one corner of one face around it: the face lies in the plane
// with v at the origin, the edge from v to `other` along +x and `target` at (x, y), y >= 0. The
// sources are on the other side, y <= 0.
template <class T>
struct Step {
  Index target, other;
  T edge, half_edge, half_inverse;  // l, l / 2, 1 / (2 l) of the edge from v to `other`
  T x, y, side, side2;              // side: |v target|
};

// The patch as the march sees it: steps by node (CSR), lengths in units of `scale`.
template <class T>
struct Complex {
  std::vector<Index> offsets;
  std::vector<Step<T>> steps;
  std::vector<T> limit;  // per node: beyond this and the march's reach it tells no neighbour
};

template <class T>
struct Scratch {
  std::vector<T> squared;      // nodes x kLanes
  std::vector<Index> touched;  // nodes that differ from kFar
  std::vector<Index> queue;    // ring buffer
  std::vector<unsigned char> is_queued, is_touched;
};

}  // namespace onmesh::unfold
#endif

HWY_BEFORE_NAMESPACE();
namespace onmesh::unfold::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// reach: of all sources, in the complex's unit.
template <class T>
void march(const Complex<T>& complex, const Index* sources, int count, T reach, Scratch<T>& s) {
  const hn::CappedTag<T, kLanes> d;
  const int lanes = int(hn::Lanes(d));
  const auto zero = hn::Zero(d), two = hn::Set(d, T(2)), far = hn::Set(d, T(kFar));
  const auto reached = hn::Set(d, T(kFar) / 2);  // whatever follows from kFar is more
  // Smaller improvements are kept, but not passed on: rounding must not keep the march busy.
  T noise = sizeof(T) == 4 ? T(1e-6) : T(1e-12);
  auto significant = hn::Set(d, 1 - noise);
  const auto tolerance = hn::Set(d, sizeof(T) == 4 ? T(-1e-5) : T(-1e-11));

  const std::size_t capacity = s.queue.size();
  std::size_t head = 0, queued = 0;
  const auto push = [&](Index node) {
    if (s.is_queued[node]) return;
    s.is_queued[node] = 1;
    std::size_t tail = head + queued++;
    s.queue[tail < capacity ? tail : tail - capacity] = node;
  };
  const auto touch = [&](Index node) {
    if (s.is_touched[node]) return;
    s.is_touched[node] = 1;
    s.touched.push_back(node);
  };
  for (int lane = 0; lane < count; ++lane) {
    s.squared[std::size_t(sources[lane]) * kLanes + lane] = 0;
    touch(sources[lane]);
    push(sources[lane]);
  }

  // A march visits a node some ten times. Where edges are so short that rounding keeps it going, it
  // has to come to an end all the same: more and more counts as noise.
  std::size_t visits = 0, patience = 64 * capacity;

  alignas(64) std::array<T, kLanes> root;
  while (queued > 0) {
    if (++visits > patience) {
      patience += capacity;
      noise = std::min(T(1), 2 * noise);
      significant = hn::Set(d, 1 - noise);
    }
    const Index v = s.queue[head];
    if (++head == capacity) head = 0;
    --queued;
    s.is_queued[v] = 0;
    const T* const at_v = s.squared.data() + std::size_t(v) * kLanes;
    for (int p = 0; p < kLanes; p += lanes)
      hn::Store(hn::Sqrt(hn::LoadU(d, at_v + p)), d, root.data() + p);

    for (Index i = complex.offsets[v]; i < complex.offsets[v + 1]; ++i) {
      const Step<T>& step = complex.steps[i];
      const T* const at_other = s.squared.data() + std::size_t(step.other) * kLanes;
      T* const at_target = s.squared.data() + std::size_t(step.target) * kLanes;
      const auto l = hn::Set(d, step.edge), half = hn::Set(d, step.half_edge);
      const auto half_inverse = hn::Set(d, step.half_inverse), side = hn::Set(d, step.side);
      const auto x = hn::Set(d, step.x), y = hn::Set(d, step.y), side2 = hn::Set(d, step.side2);
      const T beyond = reach + complex.limit[step.target];
      const auto limit2 = hn::Set(d, beyond * beyond);
      const auto floor = hn::Mul(tolerance, hn::Mul(l, l));
      bool changed = false, passes_on = false;
      for (int p = 0; p < kLanes; p += lanes) {
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
        const auto unfolded =
            hn::MulAdd(two, hn::NegMulAdd(sx, x, hn::Mul(sy, y)), hn::Add(dv, side2));
        const auto along = hn::Add(hn::LoadU(d, root.data() + p), side);
        // Not below 0: the way back to the source would be an improvement for ever.
        const auto there =
            hn::Max(hn::Min(hn::Mul(along, along), hn::IfThenElse(straight, unfolded, far)), zero);
        const auto better = hn::Lt(there, hn::Min(old, reached));
        if (hn::AllFalse(d, better)) continue;
        changed = true;
        hn::StoreU(hn::IfThenElse(better, there, old), d, at_target + p);
        passes_on |= !hn::AllFalse(
            d, hn::And(hn::Lt(there, hn::Mul(old, significant)), hn::Le(there, limit2)));
      }
      if (changed) touch(step.target);
      if (passes_on) push(step.target);
    }
  }
}

void march_float(const Complex<float>& complex, const Index* sources, int count, float reach,
                 Scratch<float>& scratch) {
  march(complex, sources, count, reach, scratch);
}
void march_double(const Complex<double>& complex, const Index* sources, int count, double reach,
                  Scratch<double>& scratch) {
  march(complex, sources, count, reach, scratch);
}

}  // namespace onmesh::unfold::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
namespace unfold {

HWY_EXPORT(march_float);
HWY_EXPORT(march_double);

namespace {

void march(const Complex<float>& complex, const Index* sources, int count, float reach,
           Scratch<float>& scratch) {
  HWY_DYNAMIC_DISPATCH(march_float)(complex, sources, count, reach, scratch);
}
void march(const Complex<double>& complex, const Index* sources, int count, double reach,
           Scratch<double>& scratch) {
  HWY_DYNAMIC_DISPATCH(march_double)(complex, sources, count, reach, scratch);
}

// Faces around each local node (CSR), each face once per node.
struct Incidence {
  std::vector<Index> offsets, faces;
  explicit Incidence(const Patch& patch) : offsets(patch.nodes.size() + 1, 0) {
    for (const auto& c : patch.corners)
      for (int k = 0; k < 3; ++k)
        if (is_first(c, k)) ++offsets[c[k] + 1];
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    faces.resize(offsets.back());
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (Index f = 0; f < patch.corners.size(); ++f)
      for (int k = 0; k < 3; ++k)
        if (is_first(patch.corners[f], k)) faces[next[patch.corners[f][k]]++] = f;
  }
  static bool is_first(const std::array<Index, 3>& c, int k) {
    return (k < 1 || c[0] != c[k]) && (k < 2 || c[1] != c[k]);
  }
};

template <class T>
Complex<T> make_complex(const Patch& patch, const Incidence& around, double scale, double slack) {
  Complex<T> complex;
  const Index nodes = Index(patch.nodes.size());
  complex.offsets.reserve(nodes + 1);
  complex.limit.reserve(nodes);
  complex.steps.reserve(6 * patch.corners.size());
  complex.offsets.push_back(0);
  const Index surface_faces = Index(patch.corners.size()) - patch.bridge_faces;
  for (Index v = 0; v < nodes; ++v) {
    double longest = 0;
    for (Index i = around.offsets[v]; i < around.offsets[v + 1]; ++i) {
      const Index f = around.faces[i];
      const auto& corner = patch.corners[f];
      const std::array<double, 3> l{patch.lengths[f][0] / scale, patch.lengths[f][1] / scale,
                                    patch.lengths[f][2] / scale};
      longest = std::max({longest, l[0], l[1], l[2]});
      for (int from = 0; from < 3; ++from) {
        if (corner[from] != v) continue;
        for (int turn = 1; turn <= 2; ++turn) {
          const int target = (from + turn) % 3, other = (from + 3 - turn) % 3;
          // lengths[k] is the edge opposite corner (k + 2) % 3.
          const double side = l[(other + 1) % 3], edge = l[(target + 1) % 3],
                       third = l[(from + 1) % 3];
          if (f >= surface_faces && target != 0) {
            // Back over a bridge paths run along its edges only: no ray passes the test with NaN.
            if (from == 0)
              complex.steps.push_back({corner[target], corner[other], 1, T(0.5), T(0.5),
                                       std::numeric_limits<T>::quiet_NaN(), 0, T(side),
                                       T(side * side)});
            continue;
          }
          if (!(edge > 0)) continue;
          const double x = (edge * edge + (side - third) * (side + third)) / (2 * edge);
          // Never 0: where three nodes lie on a line, the test whether a ray crosses the edge could
          // not tell one side from the other, and a source on that line would count as before it.
          const double y = std::sqrt(std::max(1e-24 * edge * edge, (side - x) * (side + x)));
          complex.steps.push_back({corner[target], corner[other], T(edge), T(edge / 2),
                                   T(0.5 / edge), T(x), T(y), T(side), T(side * side)});
        }
      }
    }
    complex.offsets.push_back(Index(complex.steps.size()));
    // Entries are needed up to the reach and the extents of both nodes; a node at the other end of
    // an edge from v may have an extent larger by a third of it.
    double limit = slack * longest;
    if (!patch.extents.empty()) limit += patch.extents[v] / scale + longest / 3;
    complex.limit.push_back(T(limit));
  }
  return complex;
}

// Core nodes in an order that keeps each batch of kLanes together: grown breadth-first.
std::vector<Index> order_sources(const Patch& patch, const Incidence& around) {
  std::vector<Index> order, ring;
  order.reserve(patch.core_nodes);
  std::vector<unsigned char> taken(patch.core_nodes, 0);
  std::vector<Index> seen(patch.core_nodes, kNone);
  for (Index seed = 0; seed < patch.core_nodes; ++seed) {
    if (taken[seed]) continue;
    const std::size_t full = (order.size() / kLanes + 1) * kLanes;
    ring.assign(1, seed);
    seen[seed] = seed;
    for (std::size_t next = 0; next < ring.size() && order.size() < full; ++next) {
      const Index v = ring[next];
      if (!taken[v]) {
        taken[v] = 1;
        order.push_back(v);
      }
      for (Index i = around.offsets[v]; i < around.offsets[v + 1]; ++i)
        for (const Index w : patch.corners[around.faces[i]]) {
          if (w >= patch.core_nodes || seen[w] == seed) continue;
          seen[w] = seed;
          ring.push_back(w);
        }
      // Past a small neighbourhood, start anew rather than search the patch for the last few.
      if (next > 8 * kLanes) break;
    }
  }
  return order;
}

template <class T>
void fill_table(const Patch& patch, const Incidence& around, double reach, double scale,
                double slack, DistanceTable& table) {
  const Complex<T> complex = make_complex<T>(patch, around, scale, slack);
  const std::vector<Index> order = order_sources(patch, around);
  const std::size_t nodes = patch.nodes.size();
  Scratch<T> scratch;
  scratch.squared.assign(nodes * kLanes, T(kFar));
  scratch.queue.resize(nodes);
  scratch.is_queued.assign(nodes, 0);
  scratch.is_touched.assign(nodes, 0);

  const double scale2 = scale * scale;
  for (std::size_t begin = 0; begin < order.size(); begin += kLanes) {
    const int count = int(std::min<std::size_t>(kLanes, order.size() - begin));
    double extent = 0;
    for (int lane = 0; lane < count && !patch.extents.empty(); ++lane)
      extent = std::max(extent, patch.extents[order[begin + lane]]);
    march(complex, order.data() + begin, count, T((reach + extent) / scale), scratch);
    for (const Index node : scratch.touched) {
      T* const at = scratch.squared.data() + std::size_t(node) * kLanes;
      for (int lane = 0; lane < count; ++lane)
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

  void fill(const Patch& patch, double reach, DistanceTable& table) const override {
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
      fill_table<float>(patch, around, reach, scale, 1, table);
    else
      fill_table<double>(patch, around, reach, scale, 2, table);
  }
};

}  // namespace
}  // namespace unfold

std::unique_ptr<DistanceBackend> make_unfold() { return std::make_unique<unfold::Unfold>(); }

}  // namespace onmesh
#endif  // HWY_ONCE
