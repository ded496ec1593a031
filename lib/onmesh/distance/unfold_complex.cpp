#include "onmesh/distance/unfold_complex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace onmesh::unfold {
namespace {

// Whether no earlier corner of a face is the same node.
bool is_first(const std::array<Index, 3>& c, int k) {
  return (k < 1 || c[0] != c[k]) && (k < 2 || c[1] != c[k]);
}

// Appends what a change at corner `from` of face f does to its other two corners.
template <class T>
void add_steps(const Patch& patch, Index f, int from, double scale, std::vector<Step<T>>& steps) {
  const auto& corner = patch.corners[f];
  const std::array<double, 3> l{patch.lengths[f][0] / scale, patch.lengths[f][1] / scale,
                                patch.lengths[f][2] / scale};
  const bool is_bridge = f >= patch.corners.size() - patch.bridge_faces;
  for (int turn = 1; turn <= 2; ++turn) {
    const int target = (from + turn) % 3, other = (from + 3 - turn) % 3;
    // lengths[k] is the edge opposite corner (k + 2) % 3.
    const double side = l[(other + 1) % 3], edge = l[(target + 1) % 3], third = l[(from + 1) % 3];
    if (is_bridge && target != 0) {
      // Back over a bridge paths run along its edges only: no ray passes the test with NaN.
      if (from == 0)
        steps.push_back({corner[target], corner[other], 1, T(0.5), T(0.5),
                         std::numeric_limits<T>::quiet_NaN(), 0, T(side), T(side * side)});
      continue;
    }
    if (!(edge > 0)) continue;
    const double x = (edge * edge + (side - third) * (side + third)) / (2 * edge);
    // Never 0: where three nodes lie on a line, the test whether a ray crosses the edge could
    // not tell one side from the other, and a source on that line would count as before it.
    const double y = std::sqrt(std::max(1e-24 * edge * edge, (side - x) * (side + x)));
    steps.push_back({corner[target], corner[other], T(edge), T(edge / 2), T(0.5 / edge), T(x), T(y),
                     T(side), T(side * side)});
  }
}

}  // namespace

template <class T>
Complex<T> make_complex(const Patch& patch, const Incidence& around, double scale, double slack) {
  Complex<T> complex;
  const Index nodes = Index(patch.nodes.size());
  complex.offsets.reserve(nodes + 1);
  complex.limit.reserve(nodes);
  complex.steps.reserve(6 * patch.corners.size());
  complex.offsets.push_back(0);
  for (Index v = 0; v < nodes; ++v) {
    double longest = 0;
    for (Index i = around.offsets[v]; i < around.offsets[v + 1]; ++i) {
      const Index f = around.faces[i];
      for (const double l : patch.lengths[f]) longest = std::max(longest, l / scale);
      for (int from = 0; from < 3; ++from)
        if (patch.corners[f][from] == v) add_steps(patch, f, from, scale, complex.steps);
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

template Complex<float> make_complex(const Patch&, const Incidence&, double, double);
template Complex<double> make_complex(const Patch&, const Incidence&, double, double);

Incidence::Incidence(const Patch& patch) : offsets(patch.nodes.size() + 1, 0) {
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

std::vector<Index> order_sources(const Patch& patch, const Incidence& around, std::size_t batch) {
  std::vector<Index> order, ring;
  order.reserve(patch.core_nodes);
  std::vector<unsigned char> taken(patch.core_nodes, 0);
  std::vector<Index> seen(patch.core_nodes, kNone);
  for (Index seed = 0; seed < patch.core_nodes; ++seed) {
    if (taken[seed]) continue;
    const std::size_t full = (order.size() / batch + 1) * batch;
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
      if (next > 8 * batch) break;
    }
  }
  return order;
}

}  // namespace onmesh::unfold
