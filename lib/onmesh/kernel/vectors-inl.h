// Vectors of floats as the kernels have them, compiled once per instruction set.
#if defined(ONMESH_KERNEL_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_VECTORS_INL_H_
#undef ONMESH_KERNEL_VECTORS_INL_H_
#else
#define ONMESH_KERNEL_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "onmesh/base/simd_targets.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_VECTORS_INL_H_
