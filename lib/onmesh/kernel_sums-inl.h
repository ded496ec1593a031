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

/// Records, and the corner exponents of the near face that each lies in: where they begin in their
/// arrays, since computing that from numbers would take the sums' time.
struct Hits {
  std::vector<Index> records, faces;
  std::size_t count = 0;

  void reserve(std::size_t size) {
    if (records.size() >= size) return;
    records.resize(2 * size);
    faces.resize(2 * size);
  }
};

/// A little less and a little more than the limit, since bounds are rounded differently.
inline float loose_limit(const KernelWork& work) { return work.limit * 1.0001F - 1e-4F; }
inline float tight_limit(const KernelWork& work) { return work.limit * 0.9999F + 1e-4F; }

/// List all records from `begin` to `end` of a face. \pre room for end - begin and a vector more
HWY_INLINE void add_hits(D d, const KernelWork& work, std::size_t begin, std::size_t end,
                         Index face, Hits& hits) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const auto stride = hn::Set(du, Index(work.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * work.stride())), same = hn::Set(du, face);
  for (std::size_t k = begin; k < end; k += lanes) {
    hn::StoreU(record, du, hits.records.data() + hits.count + (k - begin));
    hn::StoreU(same, du, hits.faces.data() + hits.count + (k - begin));
    record = hn::Add(record, step);
  }
  hits.count += end - begin;
}

/// Sort the records from `begin` to `end` of a face, whose exponents are at `face`, into those that
/// all targets have within the radius and those that some may have. `most` and `least`: the largest
/// and smallest exponents of any target at the face's corners; so sums of them by barycentrics are
/// the most and the least that a sample can have. Lanes are samples here. \pre room for end - begin
/// and a vector more in both
HWY_INLINE void find_hits(D d, const KernelWork& work, std::size_t begin, std::size_t end,
                          const FaceExponents<float>& most, const FaceExponents<float>& least,
                          Index face, Hits& sure, Hits& maybe) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const V some = hn::Set(d, loose_limit(work)), all = hn::Set(d, tight_limit(work));
  const V e0 = hn::Set(d, most.corner0), e1 = hn::Set(d, most.to_corner1);
  const V e2 = hn::Set(d, most.to_corner2), f0 = hn::Set(d, least.corner0);
  const V f1 = hn::Set(d, least.to_corner1), f2 = hn::Set(d, least.to_corner2);
  const auto stride = hn::Set(du, Index(work.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * work.stride())), same = hn::Set(du, face);
  const auto append = [&](Hits& hits, M which) HWY_ATTR {
    hn::StoreU(hn::Compress(record, hn::RebindMask(du, which)), du,
               hits.records.data() + hits.count);
    hn::StoreU(same, du, hits.faces.data() + hits.count);
    hits.count += hn::CountTrue(d, which);
  };
  for (std::size_t k = begin; k < end; k += lanes) {
    const V variance = hn::LoadU(d, work.variance.data() + k);
    const V b1 = hn::LoadU(d, work.b1.data() + k), b2 = hn::LoadU(d, work.b2.data() + k);
    const V x = hn::MulAdd(b2, e2, hn::MulAdd(b1, e1, hn::Add(e0, variance)));
    const V y = hn::MulAdd(b2, f2, hn::MulAdd(b1, f1, hn::Add(f0, variance)));
    const M in_face = hn::FirstN(d, end - k);
    const M is_sure = hn::And(in_face, hn::Ge(y, all));
    append(sure, is_sure);
    append(maybe, hn::AndNot(is_sure, hn::And(in_face, hn::Ge(x, some))));
    record = hn::Add(record, step);
  }
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

  /// Add one sample. kSure: all lanes have it within the radius. \return number of lanes that do
  template <bool kSure>
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
    V w = kRange == RangeTerm::product ? exp2_in_range(d, x) : exp2(d, x);
    if constexpr (!kSure) w = hn::IfThenElseZero(inside, w);
    weights = hn::Add(weights, w);
    for (int c = 0; c < kChannels; ++c) sum[c] = hn::MulAdd(w, value[c], sum[c]);
    return kSure ? hn::Lanes(d) : hn::CountTrue(d, inside);
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

  template <bool kSure>
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
