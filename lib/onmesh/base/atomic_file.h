// Files that are there as a whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

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
  friend void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files);
  void replace();
  void remember();
  void put_back();

  const std::filesystem::path path_, target_;
  std::filesystem::path before_;  ///< a second name of what the target was; empty = none
  bool was_there_ = false;        ///< there was a target, but a second name could not be had
  std::filesystem::path temporary_;
};

/// Put all files in their targets' places, or none: if one cannot be, those before it are put back.
/// Signals that end the program wait (remove_temporaries()); only SIGKILL leaves some new and some
/// old, each whole.
/// \throw FileError as AtomicFile::commit()
void commit_all(const std::vector<std::unique_ptr<AtomicFile>>& files);

/// A folder that is made for the files of one run, and removed again, if it is empty, unless
/// keep() is called. Where there is one already nothing happens.
class AtomicFolder {
 public:
  /// \throw FileError if it cannot be made; that the one around it is missing is such a case
  explicit AtomicFolder(const std::filesystem::path& path);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  void keep();

 private:
  std::filesystem::path made_;  ///< empty if it was there, or is kept
};

/// Remove the temporaries of all AtomicFiles that wait for their commit(), and folders that are not
/// kept, and let none commit from now on: for a program that ends at once.
void remove_temporaries();

}  // namespace onmesh
