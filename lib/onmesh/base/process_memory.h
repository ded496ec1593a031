// The process's memory as the system tells it.
#pragma once

#include <cstdint>
#include <optional>

namespace onmesh {

/// Largest resident set of this process so far, in bytes; 0 if the system does not tell.
std::uint64_t peak_memory_bytes();

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
