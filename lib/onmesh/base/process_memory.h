// The process's memory as the system tells it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace onmesh {

/// Largest resident set of this process so far, in bytes; 0 if the system does not tell.
std::uint64_t peak_memory_bytes();

/// What is resident now, in bytes; 0 if the system does not tell.
std::uint64_t resident_memory_bytes();

/// What this process may still take, in bytes: the least of what the machine, its control groups
/// (version 2) and the limit on its address space leave. 2^63 if the system tells nothing.
std::uint64_t available_memory_bytes();

/// "36.0 GB" (10^9 bytes), "123 MB", "1.36 KB".
std::string memory_text(std::uint64_t bytes);

/// Measures how much memory a piece of work takes, apart from what ran before it in the process.
/// Only Linux tells.
class MemoryMeter {
 public:
  /// Gives free memory back to the system and forgets the peak so far.
  MemoryMeter();

  /// Bytes resident when the meter was made; 0 if the system does not tell.
  std::uint64_t before() const { return before_; }
  /// Most bytes resident since then; none if the system does not tell.
  std::optional<std::uint64_t> peak() const;

 private:
  bool forgotten_ = false;
  std::uint64_t before_ = 0;
};

}  // namespace onmesh
