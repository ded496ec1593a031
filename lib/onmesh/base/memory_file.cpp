#include "onmesh/base/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "onmesh/base/error.h"

namespace onmesh {

MemoryFile::MemoryFile(std::string_view content) : file_(::memfd_create("onmesh", MFD_CLOEXEC)) {
  int error = file_ < 0 ? errno : 0;
  while (error == 0 && !content.empty()) {
    const ssize_t written = ::write(file_, content.data(), content.size());
    if (written < 0 && errno != EINTR) error = errno;
    if (written > 0) content.remove_prefix(std::size_t(written));
  }
  if (error != 0) {
    if (file_ >= 0) ::close(file_);
    throw FileError(std::string("cannot make a file in memory: ") + std::strerror(error));
  }
  path_ = "/proc/self/fd/" + std::to_string(file_);
}

MemoryFile::~MemoryFile() { ::close(file_); }

}  // namespace onmesh
