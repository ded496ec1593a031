// Files that are there as a whole or not at all.
#pragma once

#include <filesystem>

namespace onmesh {

/// The folder that a file is in, "." if its path names none.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Where a file goes in the end: symbolic links are followed, so that they stay links. What a link
/// names need not be there.
/// \throw FileError if links lead in a circle
std::filesystem::path follow_links(std::filesystem::path path);

/// An empty file beside its target, with a name of its own and the target's extension. It takes the
/// target's place by commit(); else it is removed. What killed runs left behind does not matter.
class AtomicFile {
 public:
  /// \param path the target; links are followed
  /// \throw FileError if the target is there and cannot be written, or if its folder cannot
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// What is to be written to, closed.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Put it in the target's place, with the permissions of what was there.
  /// \throw FileError if that fails
  void commit();

 private:
  const std::filesystem::path path_, target_;
  std::filesystem::path temporary_;
};

/// Remove the temporaries of all AtomicFiles that wait for their commit(), and let none commit from
/// now on: for a program that ends at once.
void remove_temporaries();

}  // namespace onmesh
