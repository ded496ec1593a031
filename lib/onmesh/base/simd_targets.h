// Which instruction sets vector code is compiled for. Every source that Highway compiles once per
// instruction set includes this before Highway's headers.
#pragma once

#include <cstddef>

/// Not SSSE3, which is hardly better than SSE2; nor vectors whose size is known only at run time
/// (SVE, RISC-V): vectors are put into arrays here.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

namespace onmesh {

/// Floats in the largest vector there is. What is read or written by whole vectors is padded by so
/// many, or to a multiple.
inline constexpr std::size_t kLanes = 16;

/// \return count, rounded up to a multiple of kLanes
constexpr std::size_t padded_to_lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

}  // namespace onmesh
