// Loops on all threads (includes oneTBB: for .cpp files).
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace onmesh {

/// body(i) for every i below `size`, in any order and on all threads. A thread takes at least 16
/// neighbouring numbers at a time where there are that many.
template <class Body>
void parallel_over(std::size_t size, Body&& body) {
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, size, 16),
                            [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
                            });
}

/// body(begin, end) for blocks of up to 1024 neighbouring numbers below `size`, in any order and on
/// all threads.
template <class Body>
void over_blocks(std::size_t size, const Body& body) {
  constexpr std::size_t kAtOnce = 1024;
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, size, kAtOnce),
                            [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t begin = range.begin(); begin < range.end();
                                   begin += kAtOnce)
                                body(begin, std::min(begin + kAtOnce, range.end()));
                            });
}

}  // namespace onmesh
