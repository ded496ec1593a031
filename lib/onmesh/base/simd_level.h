// Which of the instruction sets that vector code is compiled for is used.
#pragma once

#include <string>
#include <vector>

namespace onmesh {

/// The instruction sets that this machine has and the library is compiled for, best first: "AVX3",
/// "AVX2", "SSE4", "SSE2".
std::vector<std::string> simd_levels();

/// Use none better than this one from now on; empty: the best again. Results differ between
/// instruction sets by rounding: those with fused multiplication and addition round less often.
/// For tests and support; no filter may run meanwhile.
/// \throw UsageError that lists simd_levels() if it is none of them
void limit_simd(const std::string& level);

}  // namespace onmesh
