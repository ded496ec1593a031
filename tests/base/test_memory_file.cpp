#include "onmesh/base/memory_file.h"

#include <catch2/catch.hpp>

#include "onmesh/base/file_io.h"

using namespace onmesh;

TEST_CASE("a file in memory holds what it is given and is gone with its object", "[memory_file]") {
  std::filesystem::path path;
  {
    const std::string content(100'000, 'x');
    const MemoryFile file(content), other("y"), empty;
    path = file.path();
    CHECK((read_file(path) == content));
    CHECK(read_file(other.path()) == "y");
    CHECK(read_file(empty.path()).empty());
    CHECK(std::filesystem::is_regular_file(path));
    CHECK(std::filesystem::file_size(path) == content.size());
  }
  CHECK_FALSE(std::filesystem::exists(path));
}
