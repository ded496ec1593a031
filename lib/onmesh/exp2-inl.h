// 2^x for vectors, compiled once per instruction set.
#if defined(ONMESH_EXP2_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_EXP2_INL_H_
#undef ONMESH_EXP2_INL_H_
#else
#define ONMESH_EXP2_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// 2^x with a relative error below 2.7e-6. \pre x in [-126, 127]
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_in_range(D d, V x) {
  const hn::RebindToSigned<D> di;
  // Adding 1.5 * 2^23 leaves the nearest integer in the low bits of the mantissa.
  const V magic = hn::Set(d, 12582912.0F);
  const V shifted = hn::Add(x, magic);
  const V f = hn::Sub(x, hn::Sub(shifted, magic));
  // Minimax polynomial of 2^f for relative error on [-1/2, 1/2].
  V p = hn::Set(d, 0.009570102207362652F);
  p = hn::MulAdd(p, f, hn::Set(d, 0.05591785907745361F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.240247443318367F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.6931217908859253F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.9999992847442627F));
  // Multiply by 2^integer: add it to the exponent's bits.
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(di, shifted));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), exponent));
}

/// The same for any x up to 127; 2^-100 below -100. Tinier weights would make denormal products,
/// which cost some processors a hundred times as much as others.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2(D d, V x) {
  return exp2_in_range(d, hn::Max(x, hn::Set(d, -100.0F)));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_EXP2_INL_H_
