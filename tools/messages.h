// What is said on stderr while a command runs: warnings and progress.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/progress.h"

namespace onmesh::tools {

/// "onmesh: warning: ..." on stderr, line breaks replaced.
void warn(const std::string& message);
void warn(const std::vector<std::string>& messages);

/// A progress bar on stderr while it lives: only on a terminal, at most ten times a second, wiped
/// at the end. Its callback also checks for interruption, quiet or not.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Valid as long as this object.
  Progress callback();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace onmesh::tools
