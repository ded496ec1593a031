#include "scaling/process_memory.h"

#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace onmesh::bench {
namespace {

/// A line of /proc/self/status in bytes, 0 if it is not there.
std::uint64_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == name + ':' && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

}  // namespace

MemoryMeter::MemoryMeter() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  // 5 resets the peak of the resident set (proc(5)).
  std::ofstream clear("/proc/self/clear_refs");
  forgotten_ = bool(clear << "5" << std::flush);
  before_ = status_bytes("VmRSS");
}

std::optional<std::uint64_t> MemoryMeter::peak() const {
  const std::uint64_t bytes = status_bytes("VmHWM");
  return forgotten_ && bytes > 0 ? std::optional(bytes) : std::nullopt;
}

}  // namespace onmesh::bench
