// The kernel's inner loops, compiled once per instruction set (included by kernel.cpp only).
#if defined(ONMESH_KERNEL_SUMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_SUMS_INL_H_
#undef ONMESH_KERNEL_SUMS_INL_H_
#else
#define ONMESH_KERNEL_SUMS_INL_H_
#endif

#include <hwy/highway.h>

#include "onmesh/base/exp2-inl.h"
#include "onmesh/kernel/direct/records.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

/// The sum of weights that is nothing: more than a million of 2^-100.
constexpr float kNothing = 8e-25F;

/// The exponents of a block's targets over one face are linear in the sample's barycentrics:
/// corner 0's, and the differences to it at the others.
template <class T>
struct FaceExponents {
  T corner0, to_corner1, to_corner2;
};

/// Where records begin.
struct HitList {
  std::vector<Index> records;
  std::size_t count = 0;

  void reserve(std::size_t size) {
    if (records.size() < size) records.resize(2 * size);
  }
};

/// The samples within the radius of a block's targets, by what has to be looked at in their sums.
struct Hits {
  HitList sure;     ///< within the radius of all targets, at distance 0 of none
  HitList edge;     ///< within the radius of some targets, at distance 0 of none
  HitList general;  ///< the others

  void clear(std::size_t room) {
    for (HitList* list : {&sure, &edge, &general}) {
      list->reserve(room);
      list->count = 0;
    }
  }
};

/// A little less and a little more than the limit, since bounds are rounded differently.
inline float loose_limit(const KernelWork& work) {
  return work.limit * 1.0001F - 1e-4F * kExponentUnit;
}
inline float tight_limit(const KernelWork& work) {
  return work.limit * 0.9999F + 1e-4F * kExponentUnit;
}

/// List all records from `begin` to `end` of a face. \pre room for end - begin and a vector more
HWY_INLINE void add_hits(D d, const KernelWork& work, std::size_t begin, std::size_t end,
                         HitList& list) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const auto stride = hn::Set(du, Index(work.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * work.stride()));
  for (std::size_t k = begin; k < end; k += lanes) {
    hn::StoreU(record, du, list.records.data() + list.count + (k - begin));
    record = hn::Add(record, step);
  }
  list.count += end - begin;
}

/// List the records from `begin` to `end` of a face that some target may have within the radius.
/// `most` and `least`: the largest and smallest exponents of any target at the face's corners; so
/// sums of them by barycentrics are the most and the least that a sample can have. Lanes are
/// samples here. \pre room for end - begin and a vector more in all lists
HWY_INLINE void find_hits(D d, const KernelWork& work, std::size_t begin, std::size_t end,
                          const FaceExponents<float>& most, const FaceExponents<float>& least,
                          Hits& hits) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const V some = hn::Set(d, loose_limit(work)), all = hn::Set(d, tight_limit(work));
  const V e0 = hn::Set(d, most.corner0), e1 = hn::Set(d, most.to_corner1);
  const V e2 = hn::Set(d, most.to_corner2), f0 = hn::Set(d, least.corner0);
  const V f1 = hn::Set(d, least.to_corner1), f2 = hn::Set(d, least.to_corner2);
  const auto stride = hn::Set(du, Index(work.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * work.stride()));
  const auto append = [&](HitList& list, M which) HWY_ATTR {
    hn::StoreU(hn::Compress(record, hn::RebindMask(du, which)), du,
               list.records.data() + list.count);
    list.count += hn::CountTrue(d, which);
  };
  for (std::size_t k = begin; k < end; k += lanes) {
    const V variance = hn::LoadU(d, work.variance.data() + k);
    const V b1 = hn::LoadU(d, work.b1.data() + k), b2 = hn::LoadU(d, work.b2.data() + k);
    const V x = hn::MulAdd(b2, e2, hn::MulAdd(b1, e1, hn::Add(e0, variance)));
    const V y = hn::MulAdd(b2, f2, hn::MulAdd(b1, f1, hn::Add(f0, variance)));
    const M is_hit = hn::And(hn::FirstN(d, end - k), hn::Ge(x, some));
    const M is_close = hn::And(is_hit, hn::Gt(x, hn::Zero(d)));
    const M is_far = hn::AndNot(is_close, is_hit), is_sure = hn::And(is_far, hn::Ge(y, all));
    append(hits.sure, is_sure);
    append(hits.edge, hn::AndNot(is_sure, is_far));
    if (HWY_UNLIKELY(!hn::AllFalse(d, is_close))) append(hits.general, is_close);
    record = hn::Add(record, step);
  }
}

/// The exponents at a sample, without its variance.
HWY_INLINE V interpolate(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
  const V x = hn::MulAdd(hn::Set(d, record[0]), e.to_corner1, e.corner0);
  return hn::MulAdd(hn::Set(d, record[1]), e.to_corner2, x);
}

/// A sample's exponent for each target but for their colours, and which have it within the radius.
struct SpatialExponent {
  V exponent;
  M inside;

  HWY_INLINE SpatialExponent(D d, V limit, const FaceExponents<V>& e,
                             const float* HWY_RESTRICT record) {
    const V distance = interpolate(d, e, record);
    inside = hn::Ge(distance, hn::Set(d, record[3]));
    // Rounding must not make d^2 negative.
    const V least_distance = hn::Sub(hn::Set(d, record[3]), limit);
    exponent = hn::Add(hn::Min(distance, least_distance), hn::Set(d, record[2]));
  }
};

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

  /// Add a sample of Hits::sure.
  HWY_INLINE void add_sure(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    // Two short chains of operations rather than a long one: processors look ahead only so far.
    const V distance = interpolate(d, e, record);
    V value[kChannels];
    const V likeness = add_range(record, value, hn::Set(d, record[2]));
    add_weighted(raise(d, hn::Add(distance, likeness)), value);
  }

  /// Add a sample of Hits::edge. \return number of lanes that have it within the radius
  HWY_INLINE std::size_t add_edge(D d, const FaceExponents<V>& e,
                                  const float* HWY_RESTRICT record) {
    const V distance = interpolate(d, e, record);
    const M inside = hn::Ge(distance, hn::Set(d, record[3]));
    V value[kChannels];
    const V likeness = add_range(record, value, hn::Set(d, record[2]));
    add_weighted(hn::IfThenElseZero(inside, raise(d, hn::Add(distance, likeness))), value);
    return hn::CountTrue(d, inside);
  }

  /// Add any sample. \return number of lanes that have it within the radius
  HWY_INLINE std::size_t add(D d, V limit, const FaceExponents<V>& e,
                             const float* HWY_RESTRICT record) {
    const SpatialExponent spatial(d, limit, e, record);
    V value[kChannels];
    const V x = add_range(record, value, spatial.exponent);
    add_weighted(hn::IfThenElseZero(spatial.inside, raise(d, x)), value);
    return hn::CountTrue(d, spatial.inside);
  }

  HWY_INLINE void store(D d, float* sums) const {
    const std::size_t lanes = hn::Lanes(d);
    hn::Store(weights, d, sums);
    for (int c = 0; c < kChannels; ++c) hn::Store(sum[c], d, sums + std::size_t(c + 1) * lanes);
  }

 private:
  /// \return x and the colours' part of the exponent; `value` becomes what is summed
  HWY_INLINE V add_range(const float* HWY_RESTRICT record, V* value, V x) const {
    for (int c = 0; c < kChannels; ++c) {
      value[c] = hn::Set(D(), record[KernelWork::kFixed + std::size_t(c)]);
      if constexpr (kRange == RangeTerm::product) x = hn::MulAdd(value[c], own[c], x);
      if constexpr (kRange == RangeTerm::difference) {
        value[c] = hn::Sub(value[c], own[c]);
        x = hn::NegMulAdd(value[c], value[c], x);
      }
    }
    return x;
  }
  HWY_INLINE V raise(D d, V x) const {
    return kRange == RangeTerm::product ? exp2_of_units(d, x) : exp2_of_any_units(d, x);
  }
  HWY_INLINE void add_weighted(V weight, const V* value) {
    weights = hn::Add(weights, weight);
    for (int c = 0; c < kChannels; ++c) sum[c] = hn::MulAdd(weight, value[c], sum[c]);
  }
};

/// The same for any number of channels of which any number takes part in the colour difference.
template <RangeTerm kRange>
struct Sums<0, kRange> {
  const KernelWork* work = nullptr;
  const float* own = nullptr;
  float* sums = nullptr;

  HWY_INLINE void add_sure(D d, const FaceExponents<V>& e, const float* HWY_RESTRICT record) {
    add(d, hn::Set(d, work->limit), e, record);
  }
  HWY_INLINE std::size_t add_edge(D d, const FaceExponents<V>& e,
                                  const float* HWY_RESTRICT record) {
    return add(d, hn::Set(d, work->limit), e, record);
  }
  HWY_INLINE std::size_t add(D d, V limit, const FaceExponents<V>& e,
                             const float* HWY_RESTRICT record) {
    const std::size_t lanes = hn::Lanes(d);
    const auto channels = std::size_t(work->channels), range = std::size_t(work->range_channels);
    const SpatialExponent spatial(d, limit, e, record);
    V x = spatial.exponent;
    const float* const colour = record + KernelWork::kFixed;
    for (std::size_t c = 0; c < range; ++c) {
      const V difference = hn::Sub(hn::Set(d, colour[c]), hn::Load(d, own + c * lanes));
      x = hn::NegMulAdd(difference, difference, x);
    }
    const V w = hn::IfThenElseZero(spatial.inside, exp2_of_any_units(d, x));
    hn::Store(hn::Add(hn::Load(d, sums), w), d, sums);
    const V differences = hn::Set(d, range > 0 ? 1.0F : 0.0F);
    for (std::size_t c = 0; c < channels; ++c) {
      const V reference = hn::Mul(differences, hn::Load(d, own + c * lanes));
      float* const sum = sums + (c + 1) * lanes;
      const V value = hn::Sub(hn::Set(d, colour[c]), reference);
      hn::Store(hn::MulAdd(w, value, hn::Load(d, sum)), d, sum);
    }
    return hn::CountTrue(d, spatial.inside);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_SUMS_INL_H_
