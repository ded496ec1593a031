#include "onmesh/base/process_memory.h"

#include <sys/resource.h>

#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace onmesh {
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

std::uint64_t peak_memory_bytes() {
  // getrusage() would count what ran in this process before the program did (execve(2)).
  if (const std::uint64_t bytes = status_bytes("VmHWM"); bytes > 0) return bytes;
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

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

}  // namespace onmesh
