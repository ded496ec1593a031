// Which samples are within the radius of some targets, compiled once per instruction set.
#if defined(ONMESH_KERNEL_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_HITS_INL_H_
#undef ONMESH_KERNEL_HITS_INL_H_
#else
#define ONMESH_KERNEL_HITS_INL_H_
#endif

#include "onmesh/base/exponent_unit.h"
#include "onmesh/kernel/direct/records.h"
#include "onmesh/kernel/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// The exponents of a block's targets over one face are linear in the sample's barycentrics:
/// corner 0's, and the differences to it at the others.
template <class T>
struct FaceExponents {
  T corner0, to_corner1, to_corner2;
};

/// \param at the exponents at the face's corners
inline FaceExponents<float> over_face(const std::array<float, 3>& at) {
  return {at[0], at[1] - at[0], at[2] - at[0]};
}

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
inline float loose_limit(const PatchRecords& records) {
  return records.limit * 1.0001F - 1e-4F * kExponentUnit;
}
inline float tight_limit(const PatchRecords& records) {
  return records.limit * 0.9999F + 1e-4F * kExponentUnit;
}

/// List all records from `begin` to `end` of a face.
/// \pre room for end - begin and a vector more
HWY_INLINE void add_hits(D d, const PatchRecords& records, std::size_t begin, std::size_t end,
                         HitList& list) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const auto stride = hn::Set(du, Index(records.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * records.stride()));
  for (std::size_t k = begin; k < end; k += lanes) {
    hn::StoreU(record, du, list.records.data() + list.count + (k - begin));
    record = hn::Add(record, step);
  }
  list.count += end - begin;
}

/// List the records from `begin` to `end` of a face that some target may have within the radius.
/// Lanes are samples here.
/// \param most, least of the exponents of any target at the face's corners: sums of them by
///   barycentrics are the most and the least that a sample can have
/// \pre room for end - begin and a vector more in all lists
HWY_INLINE void find_hits(D d, const PatchRecords& records, std::size_t begin, std::size_t end,
                          const FaceExponents<float>& most, const FaceExponents<float>& least,
                          Hits& hits) {
  const hn::RebindToUnsigned<D> du;
  const std::size_t lanes = hn::Lanes(d);
  const V some = hn::Set(d, loose_limit(records)), all = hn::Set(d, tight_limit(records));
  const V e0 = hn::Set(d, most.corner0), e1 = hn::Set(d, most.to_corner1);
  const V e2 = hn::Set(d, most.to_corner2), f0 = hn::Set(d, least.corner0);
  const V f1 = hn::Set(d, least.to_corner1), f2 = hn::Set(d, least.to_corner2);
  const auto stride = hn::Set(du, Index(records.stride()));
  auto record = hn::Mul(hn::Iota(du, Index(begin)), stride);
  const auto step = hn::Set(du, Index(lanes * records.stride()));
  const auto append = [&](HitList& list, M which) HWY_ATTR {
    hn::StoreU(hn::Compress(record, hn::RebindMask(du, which)), du,
               list.records.data() + list.count);
    list.count += hn::CountTrue(d, which);
  };
  for (std::size_t k = begin; k < end; k += lanes) {
    const V variance = hn::LoadU(d, records.variance.data() + k);
    const V b1 = hn::LoadU(d, records.b1.data() + k), b2 = hn::LoadU(d, records.b2.data() + k);
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_HITS_INL_H_
