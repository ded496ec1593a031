#include "onmesh/base/process_memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace onmesh {
namespace {

constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 63;

/// The number after a word of a file, 0 if it is not there.
std::uint64_t number_after(const std::filesystem::path& file, const std::string& name) {
  std::ifstream status(file);
  for (std::string word; status >> word;) {
    std::uint64_t number = 0;
    if (word == name && status >> number) return number;
  }
  return 0;
}

std::uint64_t status_bytes(const std::string& name) {
  return 1024 * number_after("/proc/self/status", name + ':');
}

/// A file's number; unlimited if it has none ("max") or is not there.
std::uint64_t number_in(const std::filesystem::path& file) {
  std::uint64_t number = 0;
  return std::ifstream(file) >> number ? number : kUnlimited;
}

/// What the control group that this process is in, and those that hold it, leave.
std::uint64_t left_by_groups() {
  namespace fs = std::filesystem;
  const fs::path root = "/sys/fs/cgroup";
  std::string line;
  std::ifstream own("/proc/self/cgroup");
  while (std::getline(own, line) && line.rfind("0::/", 0) != 0) {
  }
  std::uint64_t left = kUnlimited;
  fs::path group = line.size() > 4 ? root / line.substr(4) : root;
  for (;; group = group.parent_path()) {
    const std::uint64_t most = number_in(group / "memory.max");
    if (most < kUnlimited) {
      // Pages of files count as used, but are given up before anybody is refused memory.
      const std::uint64_t files = number_after(group / "memory.stat", "inactive_file");
      const std::uint64_t taken = number_in(group / "memory.current");
      const std::uint64_t used = taken - std::min(taken, files);
      left = std::min(left, most > used ? most - used : 0);
    }
    if (group == root || !group.has_relative_path()) return left;
  }
}

std::uint64_t left_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::uint64_t used = status_bytes("VmSize");
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

}  // namespace

std::uint64_t resident_memory_bytes() { return status_bytes("VmRSS"); }

std::uint64_t available_memory_bytes() {
  const std::uint64_t machine = 1024 * number_after("/proc/meminfo", "MemAvailable:");
  return std::min({machine > 0 ? machine : kUnlimited, left_by_groups(), left_of_address_space()});
}

std::string memory_text(std::uint64_t bytes) {
  const char* const units[] = {"KB", "MB", "GB", "TB"};
  if (bytes < 1000) return std::to_string(bytes) + " B";
  int unit = 0;
  double value = double(bytes) / 1000;
  for (; value >= 1000 && unit < 3; ++unit) value /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, "%.*f %s",
                value < 10    ? 2
                : value < 100 ? 1
                              : 0,
                value, units[unit]);
  return text;
}

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
