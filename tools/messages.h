// What is said on stderr while a command runs: warnings and progress.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/image/image.h"

namespace onmesh::tools {

/// "onmesh: warning: ..." on stderr, line breaks replaced.
void warn(const std::string& message);
void warn(const std::vector<std::string>& messages);

/// While it lives what libraries print to stderr goes nowhere: some do so beside the errors that
/// they return. Our own messages, too; none is due then, but that of a signal.
class QuietLibraries {
 public:
  QuietLibraries();
  ~QuietLibraries();
  QuietLibraries(const QuietLibraries&) = delete;
  QuietLibraries& operator=(const QuietLibraries&) = delete;
};

/// read_image() without what libraries print.
/// \param warnings receives what is odd about the file
Image read_texture(const std::filesystem::path& path, std::vector<std::string>& warnings);
/// The same; what is odd is said at once.
Image read_texture(const std::filesystem::path& path);

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
