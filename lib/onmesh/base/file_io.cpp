#include "onmesh/base/file_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

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

}  // namespace

std::string read_file(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw FileError(path.string() + ": is a folder, not a file");
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
    if (used == capacity) capacity *= 2;
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
  // An existing file that may not be written must not be replaced through its folder either.
  if (fs::exists(status) && ::access(path.c_str(), W_OK) != 0) {
    fail(path, "cannot open for writing", errno);
  }
  fs::path target = fs::exists(status) ? fs::canonical(path, error) : path;
  if (error && fs::exists(status)) target = path;
  static std::atomic<unsigned> counter{0};
  fs::path temporary = target;
  temporary += ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  {
    Descriptor file{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
    if (file.fd < 0) fail(path, "cannot open for writing", errno);
    try {
      write_all(file.fd, content, path);
      // Some file systems report a full disk only now.
      const int fd = file.fd;
      file.fd = -1;
      if (::close(fd) != 0) fail(path, "cannot write", errno);
    } catch (...) {
      ::unlink(temporary.c_str());
      throw;
    }
  }
  if (fs::exists(status)) fs::permissions(temporary, status.permissions(), error);
  if (::rename(temporary.c_str(), target.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    fail(path, "cannot replace", reason);
  }
}

}  // namespace onmesh
