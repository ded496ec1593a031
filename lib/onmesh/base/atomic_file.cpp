#include "onmesh/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <system_error>

#include "onmesh/base/error.h"

namespace onmesh {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw FileError(path.string() + ": " + what + ": " + std::generic_category().message(error));
}

/// The temporaries that are there now, for a program that must end. Never destroyed: threads may
/// still use it when the program ends.
struct Temporaries {
  std::mutex mutex;
  std::set<fs::path> paths;
};
Temporaries& temporaries() {
  static auto* const all = new Temporaries;
  return *all;
}

/// \return 0 or the error number
int create(const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  return ::close(file) == 0 ? 0 : errno;
}

}  // namespace

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path follow_links(fs::path path) {
  constexpr int kLongestChain = 40;  // as the kernel has it
  const fs::path first = path;
  std::error_code error;
  for (int i = 0; fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    if (i == kLongestChain) fail(first, "cannot write the file", ELOOP);
    const fs::path to = fs::read_symlink(path, error);
    if (error) fail(first, "cannot write the file", error.value());
    path = to.is_absolute() ? to : folder_of(path) / to;
  }
  return path;
}

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(follow_links(path)) {
  // An existing file that may not be written must not be replaced through its folder either.
  if (::access(target_.c_str(), F_OK) == 0 && ::access(target_.c_str(), W_OK) != 0) {
    fail(path_, "cannot write the file", errno);
  }
  std::random_device random;
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  int error = EEXIST;
  for (int attempt = 0; attempt < 100 && error == EEXIST; ++attempt) {
    temporary_ = folder_of(target_) / (".onmesh-" + std::to_string(::getpid()) + "-" +
                                       std::to_string(random()) + target_.extension().string());
    error = create(temporary_);
  }
  if (error != 0) {
    temporary_.clear();
    fail(path_, "cannot write here", error);
  }
  all.paths.insert(temporary_);
}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  all.paths.erase(temporary_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  struct stat before {};
  if (::stat(target_.c_str(), &before) == 0) {
    ::chmod(temporary_.c_str(), before.st_mode & 07777);
  }
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail(path_, "cannot replace the file", errno);
  }
  all.paths.erase(temporary_);
  temporary_.clear();
}

void remove_temporaries() {
  Temporaries& all = temporaries();
  all.mutex.lock();  // for good
  for (const fs::path& path : all.paths) ::unlink(path.c_str());
}

}  // namespace onmesh
