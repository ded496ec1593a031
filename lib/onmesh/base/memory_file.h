// A file in memory, for libraries that take names of files only.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace onmesh {

/// A file that is on no disk and in no folder. It is gone with this object.
class MemoryFile {
 public:
  /// \throw FileError if the system gives no such file, or not one of that size
  explicit MemoryFile(std::string_view content = {});
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// By which this process may open it, to read and to write. It has no extension.
  const std::filesystem::path& path() const { return path_; }

 private:
  int file_ = -1;
  std::filesystem::path path_;
};

}  // namespace onmesh
