// What sample writes and counts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/run_program.h"

using namespace onmesh;

TEST_CASE("sample writes points of the surface that keep their distance", "[tools][sample]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t m.png --size 32");
  space.must("sample m.obj -o s.ply --spacing 0.1 --seed 3");
  auto columns = ply_columns(space / "s.ply");
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"}) {
    INFO(name);
    CHECK(columns.count(name) == 1);
  }
  const std::size_t count = columns["x"].size();
  CHECK(count >= 69);  // as many as a maximal set of these may have
  CHECK(count <= 90);
  double least = 1;
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(columns["x"][i] == Approx(columns["u"][i]).margin(1e-6));
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(
          least, std::hypot(columns["x"][i] - columns["x"][j], columns["y"][i] - columns["y"][j]));
  }
  CHECK(least >= 0.1 * (1 - 1e-9));
  const std::string first = content_of(space / "s.ply");
  space.must("sample m.obj -o s.ply --spacing 0.1 --seed 3");
  CHECK(content_of(space / "s.ply") == first);
  space.must("sample m.obj -o s.ply --spacing 0.1 --seed 4");
  CHECK(content_of(space / "s.ply") != first);
}

TEST_CASE("sample hits every texel of a uniform atlas and counts them", "[tools][sample]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t m.png --size 32");
  const auto report = nlohmann::json::parse(space.must("sample m.obj -o s.ply --json").out);
  CHECK(report["texels"]["covered"] == 32 * 32);
  CHECK(report["texels"]["hit"] == 32 * 32);
  CHECK(report["spacing"] <= report["largest_spacing"]);
  CHECK(ply_columns(space / "s.ply")["spacing"].size() == report["samples"]);
  const auto few =
      nlohmann::json::parse(space.must("sample m.obj -t m.png -o s.ply --spacing 0.2 --json").out);
  CHECK(few["texels"]["hit"] == few["samples"]);
  CHECK(few["spacing"] == few["largest_spacing"]);
  CHECK(ply_columns(space / "s.ply").count("spacing") == 0);
  CHECK(
      nlohmann::json::parse(space.must("sample m.obj -o s.ply --spacing 0.2 --json").out)["texels"]
          .is_null());
}
