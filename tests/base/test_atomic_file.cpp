#include "onmesh/base/atomic_file.h"

#include <unistd.h>

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/base/file_io.h"
#include "support/temp_folder.h"

namespace fs = std::filesystem;

using namespace onmesh;

namespace {

long files_in(const TempFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), {});
}

}  // namespace

TEST_CASE("a file takes its target's place as a whole or not at all", "[atomic_file]") {
  const TempFolder folder;
  const fs::path target = folder.file("a.txt", "old");
  fs::permissions(target, fs::perms(0640));
  {
    const AtomicFile given_up(target);
    CHECK(given_up.temporary().extension() == ".txt");
    CHECK(given_up.temporary().parent_path() == folder.path());
    CHECK(files_in(folder) == 2);
  }
  CHECK(files_in(folder) == 1);
  CHECK(read_file(target) == "old");
  AtomicFile file(target);
  write_file(file.temporary(), "new");
  file.commit();
  CHECK(read_file(target) == "new");
  CHECK(fs::status(target).permissions() == fs::perms(0640));
  CHECK(files_in(folder) == 1);
}

TEST_CASE("links stay links, also to files that are not there yet", "[atomic_file]") {
  const TempFolder folder;
  fs::create_symlink("second", folder.path() / "first");
  fs::create_symlink("real", folder.path() / "second");
  CHECK(follow_links(folder.path() / "first") == folder.path() / "real");
  write_file(folder.path() / "first", "x");
  CHECK(fs::is_symlink(folder.path() / "first"));
  CHECK(fs::is_symlink(folder.path() / "second"));
  CHECK(read_file(folder.path() / "real") == "x");
}

TEST_CASE("links in a circle are refused", "[atomic_file]") {
  const TempFolder folder;
  fs::create_symlink("b", folder.path() / "a");
  fs::create_symlink("a", folder.path() / "b");
  CHECK_THROWS_AS(follow_links(folder.path() / "a"), FileError);
  CHECK_THROWS_AS(AtomicFile(folder.path() / "a"), FileError);
  CHECK_THROWS_WITH(write_file(folder.path() / "a", "x"), Catch::Contains("a: cannot write"));
  CHECK(fs::is_symlink(folder.path() / "a"));
  CHECK(files_in(folder) == 2);
}

TEST_CASE("what killed runs left behind is in nobody's way", "[atomic_file]") {
  const TempFolder folder;
  const std::string process = std::to_string(::getpid());
  for (const std::string& name : {".onmesh-" + process, "a.txt.tmp" + process + "-0"}) {
    folder.file(name, "left");
  }
  for (int i = 0; i < 20; ++i) write_file(folder.path() / "a.txt", std::to_string(i));
  CHECK(read_file(folder.path() / "a.txt") == "19");
  CHECK(files_in(folder) == 3);
}

TEST_CASE("several files take their targets' places together or not at all", "[atomic_file]") {
  const TempFolder folder;
  const fs::path old = folder.file("old.txt", "before"), fresh = folder.path() / "fresh.txt",
                 last = folder.path() / "last.txt";
  const auto written = [&] {
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (const fs::path& path : {old, fresh, last}) {
      files.push_back(std::make_unique<AtomicFile>(path));
      write_file(files.back()->temporary(), "after");
    }
    return files;
  };
  {
    const auto files = written();
    fs::create_directory(last);  // in the way of the last one only
    CHECK_THROWS_AS(commit_all(files), FileError);
    CHECK(read_file(old) == "before");
    CHECK_FALSE(fs::exists(fresh));
  }
  fs::remove(last);
  CHECK(files_in(folder) == 1);
  commit_all(written());
  for (const fs::path& path : {old, fresh, last}) CHECK(read_file(path) == "after");
  CHECK(files_in(folder) == 3);
}

TEST_CASE("a folder for a run's files goes again unless it is kept", "[atomic_file]") {
  const TempFolder folder;
  const fs::path made = folder.path() / "made";
  { const AtomicFolder given_up(made); }
  CHECK_FALSE(fs::exists(made));
  {
    AtomicFolder kept(made);
    kept.keep();
  }
  CHECK(fs::is_directory(made));
  { const AtomicFolder there(made); }
  CHECK(fs::is_directory(made));
  CHECK_THROWS_AS(AtomicFolder(folder.path() / "no" / "such"), FileError);
}
