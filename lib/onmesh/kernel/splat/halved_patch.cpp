#include "onmesh/kernel/splat/halved_patch.h"

#include <algorithm>
#include <cassert>

#include "onmesh/base/simd_targets.h"
#include "onmesh/patches/patch_edges.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/splat/halved_patch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/kernel/vectors-inl.h"

#ifndef ONMESH_HALVED_PATCH_ONCE_
#define ONMESH_HALVED_PATCH_ONCE_
namespace onmesh {
namespace {

/// Where the entries of a halved table's columns come from: two columns of the whole one's (the
/// same twice for nodes) and a quarter of the squared length between them.
struct Columns {
  std::vector<std::int32_t> first, second;
  std::vector<float> quarter;
};

}  // namespace
}  // namespace onmesh
#endif

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// At a midpoint, from the entries at its edge's ends.
HWY_INLINE V entry_between(V a, V b, V quarter) {
  const D d;
  const V unreachable = hn::Set(d, kUnreachable);
  const V mean = hn::MulSub(hn::Set(d, 0.5F), hn::Add(a, b), quarter);
  return hn::IfThenElse(hn::Lt(hn::Max(a, b), unreachable), hn::Max(mean, hn::Zero(d)),
                        unreachable);
}

/// The row of a node.
void fill_node_row(const Columns& columns, const float* whole, float* row) {
  const D d;
  const hn::RebindToSigned<D> di;
  const std::size_t count = columns.quarter.size(), lanes = hn::Lanes(d);
  std::size_t c = 0;
  for (; c + lanes <= count; c += lanes) {
    const V a = hn::GatherIndex(d, whole, hn::LoadU(di, columns.first.data() + c));
    const V b = hn::GatherIndex(d, whole, hn::LoadU(di, columns.second.data() + c));
    hn::StoreU(entry_between(a, b, hn::LoadU(d, columns.quarter.data() + c)), d, row + c);
  }
  for (; c < count; ++c) {
    const V a = hn::Set(d, whole[columns.first[c]]), b = hn::Set(d, whole[columns.second[c]]);
    row[c] = hn::GetLane(entry_between(a, b, hn::Set(d, columns.quarter[c])));
  }
}

/// The row of a midpoint, from those of its edge's ends.
void fill_midpoint_row(const float* a, const float* b, float quarter, std::size_t count,
                       float* row) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const V q = hn::Set(d, quarter);
  std::size_t c = 0;
  for (; c + lanes <= count; c += lanes)
    hn::StoreU(entry_between(hn::LoadU(d, a + c), hn::LoadU(d, b + c), q), d, row + c);
  for (; c < count; ++c) row[c] = hn::GetLane(entry_between(hn::Set(d, a[c]), hn::Set(d, b[c]), q));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
namespace {

HWY_EXPORT(fill_node_row);
HWY_EXPORT(fill_midpoint_row);

/// The nodes of a halved patch: numbers of the whole one's nodes and of midpoints by edge, those of
/// core faces first; and the edges.
struct Numbers {
  std::vector<Index> node, midpoint;
  std::vector<std::array<Index, 2>> ends;  ///< per edge: nodes of the whole patch
  std::vector<float> quarter;              ///< per edge: a quarter of its squared length
  std::vector<std::array<Index, 3>> edge;  ///< per face of the whole patch
  Index core = 0, count = 0;               ///< of the halved patch: core nodes, all nodes
  Index whole_core;                        ///< the whole patch's core nodes

  explicit Numbers(const Patch& whole)
      : node(whole.nodes.size(), kNone), whole_core(whole.core_nodes) {
    Index edges = 0;
    edge = number_edges(whole, edges);
    midpoint.assign(edges, kNone);
    ends.resize(edges);
    quarter.resize(edges);
    for (; count < whole.core_nodes; ++count) node[count] = count;
    for (Index f = 0; f < whole.core_faces; ++f) number_midpoints(f);
    core = count;
    for (Index n = whole.core_nodes; n < node.size(); ++n) node[n] = count++;
    for (Index f = 0; f < edge.size(); ++f) {
      number_midpoints(f);
      for (int k = 0; k < 3; ++k) {
        ends[edge[f][k]] = {whole.corners[f][k], whole.corners[f][(k + 1) % 3]};
        quarter[edge[f][k]] = float(whole.lengths[f][k] * whole.lengths[f][k] / 4);
      }
    }
  }

 private:
  void number_midpoints(Index face) {
    for (const Index e : edge[face])
      if (midpoint[e] == kNone) midpoint[e] = count++;
  }
};

/// The faces of a halved patch around each other, as Patch::neighbours has it. Edge k of a face
/// runs from corner k to corner k + 1.
void glue(const Patch& whole, Patch& halved) {
  if (whole.neighbours.empty()) {
    halved.neighbours.clear();
    return;
  }
  halved.neighbours.assign(halved.corners.size(), {kNone, kNone, kNone});
  for (Index f = 0; f < whole.corners.size(); ++f) {
    for (Index k = 0; k < 3; ++k) {
      // The middle face's edge k is also edge k of the face at the corner opposite.
      const Index at_corner = 4 * f + (k + 2) % 3, middle = 4 * f + 3;
      halved.neighbours[middle][k] = 3 * at_corner + k;
      halved.neighbours[at_corner][k] = 3 * middle + k;
      const Index across = whole.neighbours[f][k];
      if (across == kNone) continue;
      // Both halves of edge k. The neighbour has it the other way round, if surfaces have two
      // sides.
      const Index g = across / 3, l = across % 3, next = (l + 1) % 3;
      const Index from = whole.corners[f][k];
      const bool same_way = from == whole.corners[g][l] && from != whole.corners[g][next];
      halved.neighbours[4 * f + k][k] = 3 * (4 * g + (same_way ? l : next)) + l;
      halved.neighbours[4 * f + (k + 1) % 3][k] = 3 * (4 * g + (same_way ? next : l)) + l;
    }
  }
}

Columns columns_of(const Numbers& numbers) {
  Columns columns;
  columns.first.resize(numbers.count);
  columns.second.resize(numbers.count);
  columns.quarter.assign(numbers.count, 0);
  for (Index n = 0; n < numbers.node.size(); ++n)
    columns.first[numbers.node[n]] = columns.second[numbers.node[n]] = std::int32_t(n);
  for (std::size_t e = 0; e < numbers.ends.size(); ++e) {
    const Index m = numbers.midpoint[e];
    columns.first[m] = std::int32_t(numbers.ends[e][0]);
    columns.second[m] = std::int32_t(numbers.ends[e][1]);
    columns.quarter[m] = numbers.quarter[e];
  }
  return columns;
}

void halve_faces(const Patch& whole, const Numbers& numbers, Patch& patch) {
  const std::size_t faces = whole.corners.size();
  patch.nodes.resize(numbers.count);
  patch.core_nodes = numbers.core;
  patch.faces.resize(4 * faces);
  patch.core_faces = 4 * whole.core_faces;
  patch.corners.resize(4 * faces);
  patch.lengths.resize(4 * faces);
  patch.longest_edge = whole.longest_edge / 2;
  for (Index f = 0; f < faces; ++f) {
    std::array<Index, 3> n{}, m{};
    for (int k = 0; k < 3; ++k) {
      n[k] = numbers.node[whole.corners[f][k]];
      m[k] = numbers.midpoint[numbers.edge[f][k]];
    }
    const std::array<double, 3> l{whole.lengths[f][0] / 2, whole.lengths[f][1] / 2,
                                  whole.lengths[f][2] / 2};
    patch.corners[4 * f] = {n[0], m[0], m[2]};
    patch.corners[4 * f + 1] = {m[0], n[1], m[1]};
    patch.corners[4 * f + 2] = {m[2], m[1], n[2]};
    patch.corners[4 * f + 3] = {m[1], m[2], m[0]};
    for (Index k = 0; k < 4; ++k) {
      patch.faces[4 * f + k] = whole.faces[f];
      patch.lengths[4 * f + k] = l;
    }
  }
  glue(whole, patch);
}

void halve_table(const DistanceTable& table, const Numbers& numbers, DistanceTable& fine) {
  fine.rows = numbers.core;
  fine.columns = numbers.count;
  fine.squared.resize(std::size_t(fine.rows) * fine.columns);
  const Columns columns = columns_of(numbers);
  const auto row = [&](Index n) { return fine.squared.data() + std::size_t(n) * fine.columns; };
  for (Index n = 0; n < numbers.whole_core; ++n)
    HWY_DYNAMIC_DISPATCH(fill_node_row)(columns, table.row(n), row(n));
  for (std::size_t e = 0; e < numbers.ends.size(); ++e) {
    if (numbers.midpoint[e] >= numbers.core) continue;
    const auto [a, b] = numbers.ends[e];
    HWY_DYNAMIC_DISPATCH(fill_midpoint_row)
    (row(numbers.node[a]), row(numbers.node[b]), numbers.quarter[e], fine.columns,
     row(numbers.midpoint[e]));
  }
}

}  // namespace

void halve(const Patch& whole, const DistanceTable& table, HalvedPatch& halved) {
  assert(whole.bridge_faces == 0);
  const Numbers numbers(whole);
  halve_faces(whole, numbers, halved.patch);
  halve_table(table, numbers, halved.table);
}

}  // namespace onmesh
#endif  // HWY_ONCE
