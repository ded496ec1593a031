// 2^x for vectors, compiled once per instruction set.
#if defined(ONMESH_EXP2_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_EXP2_INL_H_
#undef ONMESH_EXP2_INL_H_
#else
#define ONMESH_EXP2_INL_H_
#endif

#include <hwy/highway.h>

#include "onmesh/base/exponent_unit.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Highway's own conversion spends as much again on numbers that are too large.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
HWY_INLINE __m128i nearest_raw(__m128 x) { return _mm_cvtps_epi32(x); }
#if HWY_TARGET <= HWY_AVX2
HWY_INLINE __m256i nearest_raw(__m256 x) { return _mm256_cvtps_epi32(x); }
#endif
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE __m512i nearest_raw(__m512 x) { return _mm512_cvtps_epi32(x); }
#endif
/// The nearest integers.
/// \pre |x| < 2^31
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> nearest_in_range(D, V x) {
  return hn::Vec<hn::RebindToSigned<D>>{nearest_raw(x.raw)};
}
#else
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> nearest_in_range(D, V x) {
  return hn::NearestInt(x);
}
#endif

/// 2^(x / kExponentUnit) with a relative error below 2.7e-6.
/// \pre x / kExponentUnit in [-126, 127]
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_of_units(D d, V x) {
  const hn::RebindToSigned<D> di;
  // x = n + f: the integer has n above its last 23 bits, and f in them, 0 <= f < 1. Read as a float
  // (and biased) it is 2^n (1 + f), which differs from 2^n 2^f by a function of f (Schraudolph
  // 1999). So add the bits of p = 1 - (1 + f - 2^f) / 2: below 1 bits count half as much, and those
  // of 1 are the bias.
  const auto bits = nearest_in_range(d, x);
  const auto mantissa = hn::And(bits, hn::Set(di, 0x7fffff));
  const V m = hn::BitCast(d, hn::Or(mantissa, hn::Set(di, 0x3f800000)));  // 1 + f
  // Minimax polynomial of p for relative error of 2^f.
  V p = hn::Set(d, 0.006767083890736103F);
  p = hn::MulAdd(p, m, hn::Set(d, -0.0010626055300235748F));
  p = hn::MulAdd(p, m, hn::Set(d, 0.0833066925406456F));
  p = hn::MulAdd(p, m, hn::Set(d, -0.3439919948577881F));
  p = hn::MulAdd(p, m, hn::Set(d, 1.2549821138381958F));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), bits));
}

/// The same for any x / kExponentUnit up to 127; 2^-100 below -100. Tinier weights would make
/// denormal products, which cost some processors a hundred times as much as others.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_of_any_units(D d, V x) {
  return exp2_of_units(d, hn::Max(x, hn::Set(d, -100 * kExponentUnit)));
}

/// The same of x itself.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2(D d, V x) {
  return exp2_of_any_units(d, hn::Mul(x, hn::Set(d, kExponentUnit)));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_EXP2_INL_H_
