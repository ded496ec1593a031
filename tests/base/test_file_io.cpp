#include "onmesh/base/file_io.h"

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
