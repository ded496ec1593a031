#include "onmesh/kernel/splat/subnodes.h"
#include "onmesh/patches/patch_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/splat/subnodes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef ONMESH_SUBNODES_ONCE_
#define ONMESH_SUBNODES_ONCE_
namespace onmesh {
namespace {

constexpr std::size_t kLanes = 16;

/// What the blur needs to know of subnodes that may be near, as arrays padded to whole vectors.
/// Their ends are columns of the table.
struct NearSubnodes {
  std::vector<Index> subnodes, low, high;
  std::vector<float> quarter_length, half_variance;
  /// The table's entries at both ends, summed, for the node at hand.
  std::vector<float> from_node;
  std::size_t count = 0;

  void resize(std::size_t size) {
    const std::size_t padded = size + kLanes;
    for (auto* list : {&subnodes, &low, &high}) list->resize(padded);
    for (auto* list : {&quarter_length, &half_variance, &from_node}) list->resize(padded);
  }
  /// Copy others [begin, end) to the end. \pre there is room
  void append(const NearSubnodes& others, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k, ++count) {
      subnodes[count] = others.subnodes[k];
      low[count] = others.low[k];
      high[count] = others.high[k];
      quarter_length[count] = others.quarter_length[k];
      half_variance[count] = others.half_variance[k];
    }
  }
};

/// A core subnode, and what its weights have in common.
struct BlurRow {
  const float* to_second_end;  ///< table row
  float quarter_length;
  float variance;  ///< of the Gaussian, without the other subnode's half_variance
  float limit;     ///< largest squared distance
};

}  // namespace
}  // namespace onmesh
#endif

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Write the numbers of the entries up to `largest` of a table row. `near` needs room for all
/// columns and a vector more. \return how many
std::size_t find_near(const float* row, std::size_t columns, float largest, Index* near) {
  const hn::CappedTag<float, kLanes> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t count = 0, n = 0;
  for (; n + lanes <= columns; n += lanes) {
    const auto is_near = hn::Le(hn::LoadU(d, row + n), hn::Set(d, largest));
    count +=
        hn::CompressStore(hn::Iota(du, Index(n)), hn::RebindMask(du, is_near), du, near + count);
  }
  for (; n < columns; ++n) {
    near[count] = Index(n);
    count += row[n] <= largest;
  }
  return count;
}

/// Write the subnodes within the limit with their exponents. Both arrays need room for all that are
/// near and a vector more. \return how many
std::size_t weigh(const NearSubnodes& near, const BlurRow& row, Index* subnodes, float* exponents) {
  const hn::CappedTag<float, kLanes> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto quarter = hn::Set(d, 0.25F), zero = hn::Zero(d);
  const auto half_log2e = hn::Set(d, float(-0.5 * std::numbers::log2e));
  std::size_t count = 0;
  for (std::size_t k = 0; k < near.count; k += hn::Lanes(d)) {
    const auto at = [&](const std::vector<float>& list)
                        HWY_ATTR { return hn::LoadU(d, list.data() + k); };
    const auto entries = [&](const std::vector<Index>& ends) HWY_ATTR {
      return hn::GatherIndex(d, row.to_second_end, hn::BitCast(di, hn::LoadU(du, ends.data() + k)));
    };
    // Where an end is not reached the mean of the four entries is beyond all limits.
    const auto sum = hn::Add(at(near.from_node), hn::Add(entries(near.low), entries(near.high)));
    const auto lengths = hn::Add(at(near.quarter_length), hn::Set(d, row.quarter_length));
    const auto squared = hn::MulSub(quarter, sum, lengths);
    const auto variance = hn::Sub(hn::Set(d, row.variance), at(near.half_variance));
    const auto exponent = hn::Div(hn::Mul(hn::Max(squared, zero), half_log2e), variance);
    const auto is_within =
        hn::And(hn::Le(squared, hn::Set(d, row.limit)), hn::FirstN(d, near.count - k));
    hn::CompressStore(exponent, is_within, d, exponents + count);
    count += hn::CompressStore(hn::LoadU(du, near.subnodes.data() + k),
                               hn::RebindMask(du, is_within), du, subnodes + count);
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
namespace {

HWY_EXPORT(find_near);
HWY_EXPORT(weigh);

/// The real subnodes by their lower-numbered end (CSR).
struct ByNode {
  std::vector<Index> offsets;
  NearSubnodes subnodes;

  ByNode(const Subnodes& s, std::size_t nodes) : offsets(nodes + 1, 0) {
    for (Index i = 0; i < s.size(); ++i)
      if (s.is_real[i]) ++offsets[std::min(s.ends[i][0], s.ends[i][1]) + 1];
    for (std::size_t n = 0; n < nodes; ++n) offsets[n + 1] += offsets[n];
    subnodes.resize(offsets.back());
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (Index i = 0; i < s.size(); ++i) {
      if (!s.is_real[i]) continue;
      const auto [low, high] = std::minmax(s.ends[i][0], s.ends[i][1]);
      const Index at = next[low]++;
      subnodes.subnodes[at] = i;
      subnodes.low[at] = low;
      subnodes.high[at] = high;
      subnodes.quarter_length[at] = 0.25F * s.squared_length[i];
      subnodes.half_variance[at] = 0.5F * s.variance[i];
    }
  }
};

void add_variances(const Patch& patch, Subnodes& s) {
  std::vector<double> sum(s.size(), 0), area(s.size(), 0);
  for (Index f = 0; f < patch.corners.size(); ++f) {
    const auto& l = patch.lengths[f];
    // Only weights: cancellation in needles does no harm.
    const double a = l[0] * l[0], b = l[1] * l[1], c = l[2] * l[2];
    const double face_area =
        std::sqrt(std::max(4 * a * b - (a + b - c) * (a + b - c), 1e-12 * a * b));
    const double scale = s.is_split[f] ? 0.25 : 1.0;
    const double v = scale * (a + b + c) / 12;
    for (int k = 0; k < 3; ++k) {
      for (const Index i : {patch.corners[f][k], s.middle[f][k]}) {
        sum[i] += face_area * v;
        area[i] += face_area;
      }
    }
  }
  s.variance.resize(s.size());
  for (Index i = 0; i < s.size(); ++i) s.variance[i] = area[i] > 0 ? float(sum[i] / area[i]) : 0;
}

}  // namespace

Subnodes make_subnodes(const Patch& patch, double longest) {
  Subnodes s;
  Index edges = 0;
  s.middle = number_edges(patch, edges);
  const Index nodes = Index(patch.nodes.size());
  s.ends.resize(nodes + edges);
  s.squared_length.assign(nodes + edges, 0);
  s.is_real.assign(nodes + edges, 1);
  for (Index n = 0; n < nodes; ++n) s.ends[n] = {n, n};
  s.is_split.assign(patch.corners.size(), 0);
  for (Index f = 0; f < patch.corners.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index m = s.middle[f][k] += nodes;
      const double l = patch.lengths[f][k];
      s.ends[m] = {patch.corners[f][k], patch.corners[f][(k + 1) % 3]};
      s.squared_length[m] = float(l * l);
      s.is_real[m] = l > longest;
      s.is_split[f] |= s.is_real[m];
    }
  }
  add_variances(patch, s);
  for (Index f = 0; f < patch.core_faces; ++f) {
    for (int k = 0; k < 3; ++k) {
      s.core.push_back(patch.corners[f][k]);
      if (s.is_real[s.middle[f][k]]) s.core.push_back(s.middle[f][k]);
    }
  }
  // By their first ends, whose rows of the table are then used several times in a row.
  std::sort(s.core.begin(), s.core.end(), [&](Index i, Index j) {
    return std::pair(s.ends[i][0], i) < std::pair(s.ends[j][0], j);
  });
  s.core.erase(std::unique(s.core.begin(), s.core.end()), s.core.end());
  return s;
}

BlurWeights make_blur(const Patch& patch, const DistanceTable& table, const Subnodes& s,
                      double sigma, double radius) {
  const ByNode by_node(s, patch.nodes.size());
  const auto limit = float(radius * radius * (1 + 1e-5)), squared_sigma = float(sigma * sigma);
  // The middle of an edge is half an edge from its ends.
  const double reach = radius * std::sqrt(1 + 1e-5) + 1.01 * patch.longest_edge;
  const auto within = float(reach * reach);

  BlurWeights blur;
  blur.offsets.assign(1, 0);
  NearSubnodes near;
  near.resize(by_node.offsets.back());
  std::vector<Index> nodes(table.columns + kLanes);
  std::size_t count = 0;
  Index last = kNone;
  for (const Index i : s.core) {
    const auto [a, b] = s.ends[i];
    if (a != last) {
      last = a;
      near.count = 0;
      const float* const row = table.row(a);
      const std::size_t found =
          HWY_DYNAMIC_DISPATCH(find_near)(row, table.columns, within, nodes.data());
      for (std::size_t k = 0; k < found; ++k)
        near.append(by_node.subnodes, by_node.offsets[nodes[k]], by_node.offsets[nodes[k] + 1]);
      for (std::size_t k = 0; k < near.count; ++k)
        near.from_node[k] = row[near.low[k]] + row[near.high[k]];
      // Whole vectors are read.
      std::fill_n(near.low.begin() + std::ptrdiff_t(near.count), kLanes, Index(0));
      std::fill_n(near.high.begin() + std::ptrdiff_t(near.count), kLanes, Index(0));
    }
    if (blur.subnodes.size() < count + near.count + kLanes) {
      blur.subnodes.resize(2 * (count + near.count + kLanes));
      blur.exponents.resize(blur.subnodes.size());
    }
    const BlurRow row{table.row(b), 0.25F * s.squared_length[i],
                      squared_sigma - 0.5F * s.variance[i], limit};
    count += HWY_DYNAMIC_DISPATCH(weigh)(near, row, blur.subnodes.data() + count,
                                         blur.exponents.data() + count);
    blur.offsets.push_back(count);
  }
  blur.subnodes.resize(count);
  blur.exponents.resize(count);
  return blur;
}

}  // namespace onmesh
#endif
