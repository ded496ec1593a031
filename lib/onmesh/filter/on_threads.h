// Running a job on so many threads.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <new>
#include <optional>

#include "onmesh/base/error.h"
#include "onmesh/base/process_memory.h"

namespace onmesh {

/// Calls work() in an arena of its own.
/// \param threads 0 = as many as there are processors
/// \throw InputError if memory runs out, with how much is in use
template <class Work>
auto on_threads(int threads, const Work& work) {
  const int available = oneapi::tbb::info::default_concurrency();
  if (threads == 0) threads = available;
  // More threads than processors need to be allowed first.
  std::optional<oneapi::tbb::global_control> more;
  if (threads > available) {
    more.emplace(oneapi::tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  }
  oneapi::tbb::task_arena arena(threads);
  try {
    return arena.execute(work);
  } catch (const std::bad_alloc&) {
    throw InputError("out of memory, with " + memory_text(resident_memory_bytes()) +
                     " in use; choose a larger node spacing or a smaller texture");
  }
}

}  // namespace onmesh
