#include "onmesh/base/text.h"

#include <catch2/catch.hpp>

using namespace onmesh;

TEST_CASE("only one is singular", "[text]") {
  CHECK(count_text(0, "face", "faces") == "0 faces");
  CHECK(count_text(1, "face has", "faces have") == "1 face has");
  CHECK(count_text(2, "face", "faces") == "2 faces");
  CHECK(count_text(5'000'000'000, "vertex", "vertices") == "5000000000 vertices");
}
