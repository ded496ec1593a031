// The kernel's inner loops, compiled once per instruction set (included by kernel.cpp only).
#if defined(ONMESH_KERNEL_SUMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_SUMS_INL_H_
#undef ONMESH_KERNEL_SUMS_INL_H_
#else
#define ONMESH_KERNEL_SUMS_INL_H_
#endif

#include <hwy/highway.h>

#include "onmesh/exp2-inl.h"
#include "onmesh/kernel_gather.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// Exponent of lanes that must not count: far beyond any radius, but no infinity arithmetic.
constexpr float kNever = -1e30F;
/// The sum of weights that is nothing.
constexpr float kNothing = 1e-30F;

/// The exponents of a block's targets over one face are linear in the sample's barycentrics:
/// corner 0's, and the differences to it at the others.
struct FaceExponents {
  V corner0, to_corner1, to_corner2;
};

/// Samples near a block: where their records are, and the log2 of their spatial weights times area
/// for all lanes. Sums are done over whole lists, so that short faces don't make short loops.
struct NearList {
  static constexpr std::size_t kSize = 64;
  std::size_t size = 0;
  const float* records[kSize];
  HWY_ALIGN float exponents[kSize * hn::MaxLanes(D())];
};

/// Append the samples from `record` on that some lane has within the radius, until `end` or until
/// the list is full. \return where it stopped
HWY_INLINE const float* append(D d, const float* HWY_RESTRICT record, const float* end,
                               std::size_t stride, const FaceExponents& e, NearList& list,
                               std::uint64_t& pairs) {
  const std::size_t lanes = hn::Lanes(d);
  const V never = hn::Set(d, kNever);
  std::size_t size = list.size;
  for (; record != end && size < NearList::kSize; record += stride) {
    V x = hn::Add(e.corner0, hn::Set(d, record[2]));
    x = hn::MulAdd(hn::Set(d, record[0]), e.to_corner1, x);
    x = hn::MulAdd(hn::Set(d, record[1]), e.to_corner2, x);
    const M inside = hn::Ge(x, hn::Set(d, record[4]));
    // Rounding must not make d^2 negative.
    x = hn::Min(x, hn::Set(d, record[3]));
    hn::Store(hn::IfThenElse(inside, x, never), d, list.exponents + size * lanes);
    list.records[size] = record;
    const std::size_t count = hn::CountTrue(d, inside);
    pairs += count;
    size += count != 0;  // no branch: it would be mispredicted too often
  }
  list.size = size;
  return record;
}

/// Sums over a list, up to 4 channels that all take part in the colour difference. The bilateral
/// filter sums differences to the target's own colour.
template <int kChannels, bool kRange>
HWY_INLINE void add(D d, const NearList& list, const float* own, float* sums) {
  const std::size_t lanes = hn::Lanes(d);
  V reference[kChannels], sum[kChannels], weights = hn::Zero(d);
  for (int c = 0; c < kChannels; ++c) {
    reference[c] = hn::Load(d, own + std::size_t(c) * lanes);
    sum[c] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < list.size; ++k) {
    const float* HWY_RESTRICT const colour = list.records[k] + KernelWork::kFixed;
    V x = hn::Load(d, list.exponents + k * lanes);
    V value[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      value[c] = hn::Set(d, colour[c]);
      if constexpr (kRange) {
        value[c] = hn::Sub(value[c], reference[c]);
        x = hn::NegMulAdd(value[c], value[c], x);
      }
    }
    const V w = exp2(d, x);
    weights = hn::Add(weights, w);
    for (int c = 0; c < kChannels; ++c) sum[c] = hn::MulAdd(w, value[c], sum[c]);
  }
  hn::Store(hn::Add(hn::Load(d, sums), weights), d, sums);
  for (int c = 0; c < kChannels; ++c) {
    float* const total = sums + std::size_t(c + 1) * lanes;
    hn::Store(hn::Add(hn::Load(d, total), sum[c]), d, total);
  }
}

/// The same for any number of channels: weights first, then one channel after the other.
HWY_INLINE void add_general(D d, const KernelWork& work, NearList& list, const float* own,
                            float* sums) {
  const std::size_t lanes = hn::Lanes(d);
  const auto channels = std::size_t(work.channels), range = std::size_t(work.range_channels);
  V weights = hn::Zero(d);
  for (std::size_t k = 0; k < list.size; ++k) {
    const float* const colour = list.records[k] + KernelWork::kFixed;
    V x = hn::Load(d, list.exponents + k * lanes);
    for (std::size_t c = 0; c < range; ++c) {
      const V difference = hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own + c * lanes));
      x = hn::NegMulAdd(difference, difference, x);
    }
    const V w = exp2(d, x);
    weights = hn::Add(weights, w);
    hn::Store(w, d, list.exponents + k * lanes);
  }
  hn::Store(hn::Add(hn::Load(d, sums), weights), d, sums);
  const V differences = hn::Set(d, range > 0 ? 1.0F : 0.0F);
  for (std::size_t c = 0; c < channels; ++c) {
    const V reference = hn::Mul(differences, hn::Load(d, own + c * lanes));
    V sum = hn::Zero(d);
    for (std::size_t k = 0; k < list.size; ++k) {
      const V value = hn::Set(d, list.records[k][KernelWork::kFixed + c]);
      sum = hn::MulAdd(hn::Load(d, list.exponents + k * lanes), hn::Sub(value, reference), sum);
    }
    float* const total = sums + (c + 1) * lanes;
    hn::Store(hn::Add(hn::Load(d, total), sum), d, total);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SUMS_INL_H_
