#include "onmesh/base/file_io.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "support/temp_folder.h"

using namespace onmesh;

TEST_CASE("writing over a link, a folder or into nowhere does no harm", "[file_io]") {
  const TempFolder folder;
  folder.file("real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder.path() / "link.txt");
  write_file(folder.path() / "link.txt", "new");
  CHECK(std::filesystem::is_symlink(folder.path() / "link.txt"));
  CHECK(read_file(folder.path() / "real.txt") == "new");
  CHECK_THROWS_AS(write_file(folder.path(), "x"), FileError);
  CHECK_THROWS_AS(write_file(folder.path() / "none" / "x", "x"), FileError);
  write_file("/dev/null", "x");
  if (std::filesystem::exists("/dev/full"))
    CHECK_THROWS_AS(write_file("/dev/full", "x"), FileError);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 2);
}

TEST_CASE("files that other files name must be regular and not too large", "[file_io]") {
  const TempFolder folder;
  const auto path = folder.file("m.mtl", std::string(2000, 'x'));
  CHECK(read_named_file(path, 2000).size() == 2000);
  CHECK_THROWS_WITH(read_named_file(path, 1999), Catch::Contains("m.mtl: is larger than"));
  const auto pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_named_file(pipe, 2000), Catch::Contains("pipe: is not a regular file"));
  CHECK_THROWS_AS(read_named_file("/dev/zero", 2000), FileError);
  CHECK_THROWS_AS(read_named_file(folder.path() / "none", 2000), FileError);
}

TEST_CASE("a device without an end is given up", "[file_io][slow]") {
  CHECK_THROWS_WITH(read_file("/dev/zero"), Catch::Contains("does not end within 512 MiB"));
}
