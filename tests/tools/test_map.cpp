// What map writes.
#include <algorithm>
#include <catch2/catch.hpp>

#include "onmesh/image/image_io.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("map writes the surface position of every texel in named channels", "[tools][map]") {
  const Workspace space;
  // The lower left triangle of the atlas, three units wide.
  space.file("m.obj", "v 0 0 1\nv 3 0 1\nv 0 3 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  const auto json = space.must("map m.obj --resolution 12x12 -o m.exr --json").json();
  const Image image = read_image(space / "m.exr");
  CHECK(image.channel_names == json["channels"].get<std::vector<std::string>>());
  CHECK(image.channels == 11);
  int covered = 0;
  for (Index i = 0; i < 144; ++i) {
    const float* texel = image.texel(i);
    const auto value = [&](const char* name) { return texel[channel(image, name)]; };
    const double u = (i % 12 + 0.5) / 12, v = 1 - (i / 12 + 0.5) / 12;
    const bool inside = u + v <= 1 + 1e-9;
    CHECK((value("coverage") == 2) == inside);
    CHECK(value("face") == (inside ? 0 : -1));
    CHECK(value("chart") == (inside ? 0 : -1));
    CHECK(value("claims") == (inside ? 1 : 0));
    if (!inside) continue;
    ++covered;
    CHECK(value("x") == Approx(3 * u));
    CHECK(value("y") == Approx(3 * v));
    CHECK(value("z") == Approx(1));
    CHECK(value("b1") == Approx(u));
    CHECK(value("b2") == Approx(v));
    CHECK(value("b0") == Approx(1 - u - v).margin(1e-6));
    CHECK(value("area") == Approx(9.0 / 144));
  }
  CHECK(json["covered"] == covered);
}
