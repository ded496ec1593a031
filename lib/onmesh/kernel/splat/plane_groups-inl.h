// Counts as constants of the node kernel's inner loops, compiled once per instruction set.
#if defined(ONMESH_KERNEL_PLANE_GROUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ONMESH_KERNEL_PLANE_GROUPS_INL_H_
#undef ONMESH_KERNEL_PLANE_GROUPS_INL_H_
#else
#define ONMESH_KERNEL_PLANE_GROUPS_INL_H_
#endif

#include <cstddef>
#include <type_traits>

#include "onmesh/kernel/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace onmesh {
namespace HWY_NAMESPACE {
namespace {

/// Planes are summed in groups of up to so many, for which the sums stay in registers.
constexpr std::size_t kGroup = 4;

/// Call with the number of range channels as a constant: 0 stands for any number.
template <typename Call>
void with_range_channels(int channels, const Call& call) {
  switch (channels) {
    case 1:
      return call(std::integral_constant<int, 1>());
    case 3:
      return call(std::integral_constant<int, 3>());
    default:
      return call(std::integral_constant<int, 0>());
  }
}

/// Call for groups of planes with the first and, as a constant, their number.
template <typename Call>
void for_plane_groups(std::size_t planes, const Call& call) {
  std::size_t p = 0;
  for (; p + kGroup <= planes; p += kGroup) call(p, std::integral_constant<std::size_t, kGroup>());
  for (; p + 2 <= planes; p += 2) call(p, std::integral_constant<std::size_t, 2>());
  if (p < planes) call(p, std::integral_constant<std::size_t, 1>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace onmesh
HWY_AFTER_NAMESPACE();

#endif  // ONMESH_KERNEL_PLANE_GROUPS_INL_H_
