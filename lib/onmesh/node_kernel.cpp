#include "onmesh/node_kernel.h"

#include <algorithm>
#include <cmath>

#include "onmesh/node_gather.h"

// This file is compiled once per instruction set (Highway); the best one is chosen at run time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "onmesh/node_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "onmesh/exp2-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

using D = hn::CappedTag<float, Palette::kLanes>;
using V = hn::Vec<D>;

/// x := 2^x. \pre the vector's size is a multiple of kLanes
void raise(std::vector<float>& x) {
  const D d;
  for (std::size_t i = 0; i < x.size(); i += hn::Lanes(d))
    hn::StoreU(exp2(d, hn::LoadU(d, x.data() + i)), d, x.data() + i);
}

/// likeness[record][k] = f(|colour of the record - c_k|).
void compare(const NodeWork& work, const Palette& palette, const NodeWork::Records& records,
             const NodeWork::Run& run, std::vector<float>& likeness) {
  const D d;
  const std::size_t count = run.end - run.begin, padded = palette.padded;
  if (likeness.size() < count * padded) likeness.resize(2 * count * padded);
  const auto channels = std::size_t(work.range_channels);
  for (std::size_t r = 0; r < count; ++r) {
    const float* const colour =
        records.values.data() + (run.begin + r) * work.stride() + NodeWork::kBarycentrics + 1;
    for (std::size_t k = 0; k < padded; k += hn::Lanes(d)) {
      V x = hn::Zero(d);
      for (std::size_t c = 0; c < channels; ++c) {
        const V difference =
            hn::Sub(hn::Set(d, colour[c]), hn::LoadU(d, palette.colours.data() + c * padded + k));
        x = hn::NegMulAdd(difference, difference, x);
      }
      hn::StoreU(exp2(d, x), d, likeness.data() + r * padded + k);
    }
  }
}

/// Add `count` values per record and corner to the corners' sums, `values(record, i)` giving the
/// i-th vector of them.
template <typename Values>
HWY_INLINE void splat_run(const NodeWork& work, const NodeWork::Run& run, std::size_t row,
                          std::size_t at, float* sums, const Values& values) {
  const D d;
  V sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0;
  const float* record = work.samples.values.data() + run.begin * work.stride();
  for (std::size_t r = run.begin; r < run.end; ++r, record += work.stride()) {
    const V value = values(record, r - run.begin);
    sum0 = hn::MulAdd(hn::Set(d, record[0]), value, sum0);
    sum1 = hn::MulAdd(hn::Set(d, record[1]), value, sum1);
    sum2 = hn::MulAdd(hn::Set(d, record[2]), value, sum2);
  }
  const auto add = [&](Index subnode, V sum) {
    float* const to = sums + subnode * row + at;
    hn::StoreU(hn::Add(hn::LoadU(d, to), sum), d, to);
  };
  add(run.corners[0], sum0);
  add(run.corners[1], sum1);
  add(run.corners[2], sum2);
}

void splat(NodeKernelState& s) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), padded = s.palette.padded;
  const std::size_t planes = s.work.planes();
  float* const sums = s.splatted.data();
  for (const NodeWork::Run& run : s.work.samples.runs) {
    if (s.work.range_channels == 0) {
      for (std::size_t i = 0; i < s.row; i += lanes) {
        splat_run(s.work, run, s.row, i, sums, [&](const float* record, std::size_t) {
          return hn::LoadU(d, record + NodeWork::kBarycentrics + i);
        });
      }
      continue;
    }
    compare(s.work, s.palette, s.work.samples, run, s.likeness);
    for (std::size_t p = 0; p < planes; ++p) {
      for (std::size_t k = 0; k < padded; k += lanes) {
        splat_run(s.work, run, s.row, p * padded + k, sums,
                  [&](const float* record, std::size_t r) {
                    return hn::Mul(hn::Set(d, record[NodeWork::kBarycentrics + p]),
                                   hn::LoadU(d, s.likeness.data() + r * padded + k));
                  });
      }
    }
  }
}

/// What was added to midpoints that stand for their edge's ends goes there.
void share_out(NodeKernelState& s) {
  const D d;
  for (Index i = 0; i < s.subnodes.size(); ++i) {
    if (s.subnodes.is_real[i]) continue;
    for (const Index end : s.subnodes.ends[i]) {
      const float* const from = s.splatted.data() + i * s.row;
      float* const to = s.splatted.data() + end * s.row;
      for (std::size_t k = 0; k < s.row; k += hn::Lanes(d))
        hn::StoreU(hn::MulAdd(hn::Set(d, 0.5F), hn::LoadU(d, from + k), hn::LoadU(d, to + k)), d,
                   to + k);
    }
  }
}

/// kVectors at a time of each core subnode's row.
template <int kVectors>
HWY_INLINE void blur_columns(NodeKernelState& s, std::size_t at) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < s.subnodes.core.size(); ++i) {
    V sum[kVectors];
    for (V& x : sum) x = hn::Zero(d);
    for (std::size_t k = s.blur.offsets[i]; k < s.blur.offsets[i + 1]; ++k) {
      const V weight = hn::Set(d, s.blur.exponents[k]);
      const float* const from = s.splatted.data() + s.blur.subnodes[k] * s.row + at;
      for (int v = 0; v < kVectors; ++v)
        sum[v] = hn::MulAdd(weight, hn::LoadU(d, from + std::size_t(v) * lanes), sum[v]);
    }
    float* const to = s.blurred.data() + s.subnodes.core[i] * s.row + at;
    for (int v = 0; v < kVectors; ++v) hn::StoreU(sum[v], d, to + std::size_t(v) * lanes);
  }
}

void blur(NodeKernelState& s) {
  const std::size_t lanes = hn::Lanes(D());
  std::size_t at = 0;
  for (; at + 8 * lanes <= s.row; at += 8 * lanes) blur_columns<8>(s, at);
  for (; at + 4 * lanes <= s.row; at += 4 * lanes) blur_columns<4>(s, at);
  for (; at < s.row; at += lanes) blur_columns<1>(s, at);
}

/// Multiply each plane of every core subnode by the palette's inverse.
void solve(NodeKernelState& s) {
  const D d;
  const std::size_t padded = s.palette.padded, lanes = hn::Lanes(d);
  std::vector<float> plane(padded);
  for (const Index i : s.subnodes.core) {
    for (std::size_t p = 0; p < s.work.planes(); ++p) {
      float* const at = s.blurred.data() + i * s.row + p * padded;
      std::copy_n(at, padded, plane.begin());
      for (std::size_t k = 0; k < padded; k += lanes) {
        V sum = hn::Zero(d);
        for (std::size_t l = 0; l < s.palette.size; ++l)
          sum = hn::MulAdd(hn::Set(d, plane[l]),
                           hn::LoadU(d, s.palette.inverse.data() + l * padded + k), sum);
        hn::StoreU(sum, d, at + k);
      }
    }
  }
}

/// Midpoints that stand for their edge's ends get the mean of them.
void fill_in(NodeKernelState& s) {
  const D d;
  for (Index i = 0; i < s.subnodes.size(); ++i) {
    if (s.subnodes.is_real[i]) continue;
    const float* const a = s.blurred.data() + s.subnodes.ends[i][0] * s.row;
    const float* const b = s.blurred.data() + s.subnodes.ends[i][1] * s.row;
    float* const to = s.blurred.data() + i * s.row;
    for (std::size_t k = 0; k < s.row; k += hn::Lanes(d)) {
      const V sum = hn::Add(hn::LoadU(d, a + k), hn::LoadU(d, b + k));
      hn::StoreU(hn::Mul(hn::Set(d, 0.5F), sum), d, to + k);
    }
  }
}

/// sums: per plane the interpolated value at a target.
HWY_INLINE void interpolate(const NodeKernelState& s, const NodeWork::Run& run, const float* record,
                            std::size_t r, float* sums) {
  const D d;
  const float* const n0 = s.blurred.data() + run.corners[0] * s.row;
  const float* const n1 = s.blurred.data() + run.corners[1] * s.row;
  const float* const n2 = s.blurred.data() + run.corners[2] * s.row;
  const V a0 = hn::Set(d, record[0]), a1 = hn::Set(d, record[1]), a2 = hn::Set(d, record[2]);
  const auto at = [&](std::size_t k) {
    const V two = hn::MulAdd(a1, hn::LoadU(d, n1 + k), hn::Mul(a2, hn::LoadU(d, n2 + k)));
    return hn::MulAdd(a0, hn::LoadU(d, n0 + k), two);
  };
  if (s.work.range_channels == 0) {
    for (std::size_t k = 0; k < s.row; k += hn::Lanes(d)) hn::StoreU(at(k), d, sums + k);
    return;
  }
  const std::size_t padded = s.palette.padded;
  const float* const likeness = s.likeness.data() + r * padded;
  for (std::size_t p = 0; p < s.work.planes(); ++p) {
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < padded; k += hn::Lanes(d))
      sum = hn::MulAdd(hn::LoadU(d, likeness + k), at(p * padded + k), sum);
    sums[p] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

void slice(NodeKernelState& s, std::vector<float>& out, std::vector<float>& support) {
  const NodeWork& work = s.work;
  const auto channels = std::size_t(work.channels);
  std::vector<float> sums(s.row + work.planes());
  for (const NodeWork::Run& run : work.targets.runs) {
    if (work.range_channels > 0) compare(work, s.palette, work.targets, run, s.likeness);
    const float* record = work.targets.values.data() + run.begin * work.stride();
    for (std::size_t r = run.begin; r < run.end; ++r, record += work.stride()) {
      interpolate(s, run, record, r - run.begin, sums.data());
      const Index slot = work.target_slots[r];
      if (!(sums[0] > 0)) continue;
      support[slot] = sums[0] / work.target_areas[r];
      const float inverse = 1 / (sums[0] * work.colour_scale);
      for (std::size_t c = 0; c < channels; ++c)
        out[slot * channels + c] = work.reference[c] + sums[1 + c] * inverse;
    }
  }
}

void evaluate(NodeKernelState& s, std::vector<float>& out, std::vector<float>& support) {
  splat(s);
  share_out(s);
  blur(s);
  if (s.work.range_channels > 0) solve(s);
  fill_in(s);
  slice(s, out, support);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace onmesh {
HWY_EXPORT(raise);
HWY_EXPORT(evaluate);

NodeKernel::NodeKernel(const KernelOptions& options)
    : options_(options), state_(std::make_unique<NodeKernelState>()) {}
NodeKernel::~NodeKernel() = default;
NodeKernel::NodeKernel(NodeKernel&&) noexcept = default;

bool NodeKernel::load(const KernelInput& input) {
  NodeKernelState& s = *state_;
  const double sigma = options_.sigma_spatial;
  // Subnodes half of sigma apart are as good as the node table itself.
  s.subnodes = make_subnodes(*input.patch, 0.5 * sigma);
  // Interpolation must not blur as much as the filter.
  for (const float v : s.subnodes.variance)
    if (v > 0.5 * sigma * sigma) return false;
  s.blur = make_blur(*input.patch, *input.table, s.subnodes, sigma, options_.radius);
  // Padded, so that vectors of any size fit.
  const std::size_t entries = s.blur.subnodes.size();
  s.blur.exponents.resize((entries + Palette::kLanes - 1) / Palette::kLanes * Palette::kLanes);
  HWY_DYNAMIC_DISPATCH(raise)(s.blur.exponents);
  gather(input, s.subnodes, s.blur, options_, s.work, s.kept);
  return true;
}

int NodeKernel::evaluate(int colours, std::vector<float>& out, std::vector<float>& support) {
  NodeKernelState& s = *state_;
  out = s.kept;
  support.assign(s.work.slots, 0);
  const NodeWork::Records& samples = s.work.samples;
  if (samples.count == 0) return 0;
  if (s.work.range_channels > 0) {
    s.palette =
        make_palette(samples.values.data() + NodeWork::kBarycentrics + 1, samples.count,
                     s.work.stride(), std::size_t(s.work.range_channels), std::size_t(colours));
    s.row = s.work.planes() * s.palette.padded;
  } else {
    s.row = (s.work.planes() + Palette::kLanes - 1) / Palette::kLanes * Palette::kLanes;
  }
  s.splatted.assign(s.subnodes.size() * s.row, 0);
  s.blurred.resize(s.splatted.size());
  HWY_DYNAMIC_DISPATCH(evaluate)(s, out, support);
  return s.work.range_channels > 0 ? int(s.palette.size) : 0;
}

}  // namespace onmesh
#endif
