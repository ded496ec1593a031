#include "onmesh/kernel/splat/blur.h"

#include <algorithm>
#include <numbers>

#include "onmesh/base/simd_targets.h"
#include "onmesh/kernel/radius.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/kernel/splat/blur.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/vectors-inl.h"

#ifndef ONMESH_BLUR_ONCE_
#define ONMESH_BLUR_ONCE_
namespace onmesh {
namespace {

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
  /// Copy others [begin, end) to the end.
  /// \pre there is room
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

/// Write the numbers of the entries up to `largest` of a table row.
/// \pre `near` has room for all columns and a vector more
/// \return how many
std::size_t find_near(const float* row, std::size_t columns, float largest, Index* near) {
  const D d;
  const hn::RebindToUnsigned<D> du;
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

/// Write the subnodes within the limit with their exponents of two.
/// \pre both arrays have room for all that are near and a vector more
/// \return how many
std::size_t weigh(const NearSubnodes& near, const BlurRow& row, Index* subnodes, float* exponents) {
  const D d;
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
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

/// x := 2^x
/// \pre the vector's size is a multiple of kLanes
void raise(std::vector<float>& x) {
  const D d;
  for (std::size_t i = 0; i < x.size(); i += hn::Lanes(d))
    hn::StoreU(exp2(d, hn::LoadU(d, x.data() + i)), d, x.data() + i);
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
HWY_EXPORT(raise);

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

/// Lists the subnodes near one node after the other.
class NearFinder {
 public:
  /// \param reach largest distance from a node to one of the ends of a subnode that may count
  NearFinder(const DistanceTable& table, const Subnodes& subnodes, std::size_t nodes, double reach)
      : table_(table),
        by_node_(subnodes, nodes),
        largest_(float(reach * reach)),
        nodes_(table.columns + kLanes) {
    near_.resize(by_node_.offsets.back());
  }

  /// \return the subnodes near a core node, with the table's entries from it
  const NearSubnodes& find(Index node) {
    if (node == node_) return near_;
    node_ = node;
    near_.count = 0;
    const float* const row = table_.row(node);
    const std::size_t found =
        HWY_DYNAMIC_DISPATCH(find_near)(row, table_.columns, largest_, nodes_.data());
    for (std::size_t k = 0; k < found; ++k)
      near_.append(by_node_.subnodes, by_node_.offsets[nodes_[k]], by_node_.offsets[nodes_[k] + 1]);
    for (std::size_t k = 0; k < near_.count; ++k)
      near_.from_node[k] = row[near_.low[k]] + row[near_.high[k]];
    // Whole vectors are read.
    std::fill_n(near_.low.begin() + std::ptrdiff_t(near_.count), kLanes, Index(0));
    std::fill_n(near_.high.begin() + std::ptrdiff_t(near_.count), kLanes, Index(0));
    return near_;
  }

 private:
  const DistanceTable& table_;
  const ByNode by_node_;
  const float largest_;
  std::vector<Index> nodes_;
  NearSubnodes near_;
  Index node_ = kNone;
};

}  // namespace

BlurWeights make_blur(const Patch& patch, const DistanceTable& table, const Subnodes& s,
                      double sigma, double radius) {
  // The middle of an edge is half an edge from its ends.
  const double reach = largest_distance(radius) + 1.01 * patch.longest_edge;
  NearFinder finder(table, s, patch.nodes.size(), reach);
  const auto limit = float(largest_squared(radius)), squared_sigma = float(sigma * sigma);
  BlurWeights blur;
  blur.offsets.assign(1, 0);
  std::size_t count = 0;
  for (const Index i : s.core) {
    const auto [a, b] = s.ends[i];
    const NearSubnodes& near = finder.find(a);
    if (blur.subnodes.size() < count + near.count + kLanes) {
      blur.subnodes.resize(2 * (count + near.count + kLanes));
      blur.weights.resize(blur.subnodes.size());
    }
    const BlurRow row{table.row(b), 0.25F * s.squared_length[i],
                      squared_sigma - 0.5F * s.variance[i], limit};
    count += HWY_DYNAMIC_DISPATCH(weigh)(near, row, blur.subnodes.data() + count,
                                         blur.weights.data() + count);
    blur.offsets.push_back(count);
  }
  blur.subnodes.resize(count);
  blur.weights.resize(count);
  blur.weights.resize(padded_to_lanes(count));
  HWY_DYNAMIC_DISPATCH(raise)(blur.weights);
  return blur;
}

std::vector<unsigned char> subnodes_read(const Subnodes& subnodes, const BlurWeights& blur) {
  std::vector<unsigned char> is_read(subnodes.size(), 0);
  for (const Index i : blur.subnodes) is_read[i] = 1;
  for (Index i = 0; i < subnodes.size(); ++i) {
    if (subnodes.is_real[i]) continue;
    is_read[i] = is_read[subnodes.ends[i][0]] | is_read[subnodes.ends[i][1]];
  }
  return is_read;
}

}  // namespace onmesh
#endif  // HWY_ONCE
