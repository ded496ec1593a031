// How long the steps of a command take.
#pragma once

#include <chrono>
#include <utility>

namespace onmesh::tools {

/// Runs from the start. Wall clock, seconds.
class Stopwatch {
 public:
  /// Since the last lap.
  double lap() {
    const auto now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }
  /// Since the start.
  double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace onmesh::tools
