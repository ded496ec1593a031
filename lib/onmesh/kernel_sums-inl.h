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

/// The sum of weights that is nothing: more than a million of the smallest that exp2() gives.
constexpr float kNothing = 8e-25F;

/// The exponents of a block's targets over one face are linear in the sample's barycentrics:
/// corner 0's, and the differences to it at the others.
template <class T>
struct FaceExponents {
  T corner0, to_corner1, to_corner2;
};

/// Numbers of the records from `begin` to `end` that some target may have within the radius.
/// `most`: the largest exponents of any target at the face's corners; so a sum of them by
/// barycentrics is the most that a sample can have. Lanes are samples here. \param hits room for
/// end - begin and a vector more \return how many there are
HWY_INLINE std::size_t find_hits(D d, const KernelWork& work, std::size_t begin, std::size_t end,
                                 const FaceExponents<float>& most, float limit, Index face,
                                 Index* hits, Index* faces) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const V e0 = hn::Set(d, most.corner0), e1 = hn::Set(d, most.to_corner1);
  const V e2 = hn::Set(d, most.to_corner2), least = hn::Set(d, limit);
  auto number = hn::Iota(du, Index(begin));
  const auto step = hn::Set(du, Index(lanes)), same = hn::Set(du, face);
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += lanes) {
    V x = hn::Add(e0, hn::LoadU(d, work.variance.data() + k));
    x = hn::MulAdd(hn::LoadU(d, work.b1.data() + k), e1, x);
    x = hn::MulAdd(hn::LoadU(d, work.b2.data() + k), e2, x);
    const M hit = hn::And(hn::Ge(x, least), hn::FirstN(d, end - k));
    hn::StoreU(hn::Compress(number, hn::RebindMask(du, hit)), du, hits + count);
    hn::StoreU(same, du, faces + count);
    count += hn::CountTrue(d, hit);
    number = hn::Add(number, step);
  }
  return count;
}

/// The sums of a block: of weights, and of weighted values of up to 4 channels that all take part
/// in the colour difference. With differences, the values are differences to the target's own
/// colour.
template <int kChannels, RangeTerm kRange>
struct Sums {
  V own[kChannels], sum[kChannels], weights;

  HWY_INLINE void clear(D d, const float* colours) {
    const std::size_t lanes = hn::Lanes(d);
    weights = hn::Zero(d);
    for (int c = 0; c < kChannels; ++c) {
      own[c] = hn::Load(d, colours + std::size_t(c) * lanes);
      sum[c] = hn::Zero(d);
    }
  }

  /// Add one sample. \return number of lanes within the radius
  HWY_INLINE std::size_t add(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    V x = hn::Add(e.corner0, hn::Set(d, record[2]));
    x = hn::MulAdd(hn::Set(d, record[0]), e.to_corner1, x);
    x = hn::MulAdd(hn::Set(d, record[1]), e.to_corner2, x);
    const M inside = hn::Ge(x, hn::Set(d, record[4]));
    // Rounding must not make d^2 negative.
    x = hn::Min(x, hn::Set(d, record[3]));
    const float* const colour = record + KernelWork::kFixed;
    V value[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      value[c] = hn::Set(d, colour[c]);
      if constexpr (kRange == RangeTerm::product) x = hn::MulAdd(value[c], own[c], x);
      if constexpr (kRange == RangeTerm::difference) {
        value[c] = hn::Sub(value[c], own[c]);
        x = hn::NegMulAdd(value[c], value[c], x);
      }
    }
    V w;
    if constexpr (kRange == RangeTerm::product) {
      w = hn::IfThenElseZero(inside, exp2_in_range(d, x));
    } else {
      w = hn::IfThenElseZero(inside, exp2(d, x));
    }
    weights = hn::Add(weights, w);
    for (int c = 0; c < kChannels; ++c) sum[c] = hn::MulAdd(w, value[c], sum[c]);
    return hn::CountTrue(d, inside);
  }

  HWY_INLINE void store(D d, float* sums) const {
    const std::size_t lanes = hn::Lanes(d);
    hn::Store(weights, d, sums);
    for (int c = 0; c < kChannels; ++c) hn::Store(sum[c], d, sums + std::size_t(c + 1) * lanes);
  }
};

/// The same for any number of channels of which any number takes part in the colour difference.
template <RangeTerm kRange>
struct Sums<0, kRange> {
  const KernelWork* work = nullptr;
  const float* own = nullptr;
  float* sums = nullptr;

  HWY_INLINE std::size_t add(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    const std::size_t lanes = hn::Lanes(d);
    const auto channels = std::size_t(work->channels), range = std::size_t(work->range_channels);
    V x = hn::Add(e.corner0, hn::Set(d, record[2]));
    x = hn::MulAdd(hn::Set(d, record[0]), e.to_corner1, x);
    x = hn::MulAdd(hn::Set(d, record[1]), e.to_corner2, x);
    const M inside = hn::Ge(x, hn::Set(d, record[4]));
    x = hn::Min(x, hn::Set(d, record[3]));
    const float* const colour = record + KernelWork::kFixed;
    for (std::size_t c = 0; c < range; ++c) {
      const V difference = hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own + c * lanes));
      x = hn::NegMulAdd(difference, difference, x);
    }
    const V w = hn::IfThenElseZero(inside, exp2(d, x));
    hn::Store(hn::Add(hn::Load(d, sums), w), d, sums);
    const V differences = hn::Set(d, range > 0 ? 1.0F : 0.0F);
    for (std::size_t c = 0; c < channels; ++c) {
      const V reference = hn::Mul(differences, hn::Load(d, own + c * lanes));
      float* const sum = sums + (c + 1) * lanes;
      const V value = hn::Sub(hn::Set(d, colour[c]), reference);
      hn::Store(hn::MulAdd(w, value, hn::Load(d, sum)), d, sum);
    }
    return hn::CountTrue(d, inside);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SUMS_INL_H_
