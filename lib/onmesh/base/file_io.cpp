#include "onmesh/base/file_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "onmesh/base/atomic_file.h"
#include "onmesh/base/error.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
  throw FileError(path.string() + ": " + what + ": " + std::generic_category().message(error));
}

/// Closes the descriptor at the end of the scope.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

void write_all(int fd, std::string_view content, const fs::path& path) {
  while (!content.empty()) {
    const ssize_t n = ::write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(path, "cannot write", n < 0 ? errno : EIO);
    content.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Pipes and devices are not read any further.
constexpr std::size_t kLongestStream = std::size_t{512} << 20;

}  // namespace

std::string read_named_file(const fs::path& path, std::uintmax_t largest) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw FileError(path.string() + ": is not a regular file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > largest) {
    throw FileError(path.string() + ": is larger than the " + std::to_string(largest >> 20) +
                    " MiB that are read of such a file");
  }
  return read_file(path);
}

std::string read_file(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw FileError(path.string() + ": is a folder, not a file");
  const bool regular = fs::is_regular_file(path, ignored);
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.fd < 0) fail(path, "cannot open", errno);
  std::string content;
  const auto size = fs::file_size(path, ignored);
  // One byte more than the size, so that a regular file's end is seen without growing the buffer.
  std::size_t capacity = ignored ? std::size_t{1} << 16 : static_cast<std::size_t>(size) + 1;
  std::size_t used = 0;
  for (;;) {
    try {
      content.resize(capacity);
    } catch (const std::exception&) {
      throw FileError(path.string() + ": too large to read into memory");
    }
    const ssize_t n = ::read(file.fd, content.data() + used, capacity - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, "cannot read", errno);
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
    if (!regular && used >= kLongestStream) {
      throw FileError(path.string() + ": does not end within 512 MiB; store it in a file");
    }
    if (used == capacity)
      capacity = regular ? 2 * capacity : std::min(2 * capacity, kLongestStream);
  }
  content.resize(used);
  return content;
}

void write_file(const fs::path& path, std::string_view content) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::is_directory(status)) throw FileError(path.string() + ": is a folder, not a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const Descriptor file{::open(path.c_str(), O_WRONLY | O_CLOEXEC)};
    if (file.fd < 0) fail(path, "cannot open for writing", errno);
    write_all(file.fd, content, path);
    return;
  }
  AtomicFile target(path);
  Descriptor file{::open(target.temporary().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)};
  if (file.fd < 0) fail(path, "cannot open for writing", errno);
  write_all(file.fd, content, path);
  // Some file systems report a full disk only now.
  const int fd = std::exchange(file.fd, -1);
  if (::close(fd) != 0) fail(path, "cannot write", errno);
  target.commit();
}

}  // namespace onmesh
