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
  std::set<fs::path> paths, folders;
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

/// Put the file in the target's place. The lock of the temporaries is held.
void AtomicFile::replace() {
  struct stat before {};
  if (::stat(target_.c_str(), &before) == 0) {
    ::chmod(temporary_.c_str(), before.st_mode & 07777);
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail(path_, "cannot replace the file", errno);
  }
  temporaries().paths.erase(temporary_);
  temporary_.clear();
}

/// Keep a second name of the target. Where file systems have none, the target cannot be put back.
void AtomicFile::remember() {
  const std::filesystem::path name = temporary_.string() + ".before";
  if (::link(target_.c_str(), name.c_str()) == 0) {
    before_ = name;
  } else {
    was_there_ = errno != ENOENT;
  }
}

/// Undo replace(). What cannot be put back stays the new file: better than none.
void AtomicFile::put_back() {
  if (!before_.empty()) {
    ::rename(before_.c_str(), target_.c_str());
  } else if (!was_there_) {
    ::unlink(target_.c_str());
  }
}

void AtomicFile::commit() {
  const std::lock_guard lock(temporaries().mutex);
  replace();
}

void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files) {
  const std::lock_guard lock(temporaries().mutex);
  // A single file needs no way back.
  if (files.size() > 1) {
    for (const auto& file : files) file->remember();
  }
  std::size_t done = 0;
  const auto forget = [&] {
    for (const auto& file : files) {
      if (!file->before_.empty()) ::unlink(file->before_.c_str());
    }
  };
  try {
    for (; done < files.size(); ++done) files[done]->replace();
  } catch (const FileError&) {
    while (done-- > 0) files[done]->put_back();
    forget();
    throw;
  }
  forget();
}

AtomicFolder::AtomicFolder(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  if (::mkdir(path.c_str(), 0777) != 0) fail(path, "cannot make the folder", errno);
  made_ = path;
  all.folders.insert(made_);
}

AtomicFolder::~AtomicFolder() {
  if (made_.empty()) return;
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  all.folders.erase(made_);
  ::rmdir(made_.c_str());
}

void AtomicFolder::keep() {
  if (made_.empty()) return;
  Temporaries& all = temporaries();
  const std::lock_guard lock(all.mutex);
  all.folders.erase(made_);
  made_.clear();
}

void remove_temporaries() {
  Temporaries& all = temporaries();
  all.mutex.lock();  // for good
  for (const fs::path& path : all.paths) ::unlink(path.c_str());
  for (const fs::path& path : all.folders) ::rmdir(path.c_str());
}

}  // namespace onmesh
