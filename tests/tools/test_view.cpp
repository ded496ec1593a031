// What view draws, and what it refuses.
#include <catch2/catch.hpp>

#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("a picture of the model is written, also from distances", "[tools]") {
  const Workspace space;
  space.must("make-mesh sphere --levels 2 -o m.obj -t m.png --size 32");
  space.must("view m.obj -t m.png --after m.png -o p.png --size 64");
  space.must("distance m.obj --vertex 0 -o d.ply");
  space.must("view m.obj --distance-ply d.ply -o d.png --size 64");
  const Run same = space.run("compare p.png d.png");
  CHECK(same.code == 3);  // two views side by side are wider
  CHECK_THAT(same.err, Contains("64 x 64 with 3 channels"));
}

TEST_CASE("view puts any number of textures beside each other, on the model or flat", "[tools]") {
  const Workspace space;
  space.must("make-mesh sphere --levels 2 -o m.obj -t m.png --size 32");
  space.must("view m.obj -t m.png --after m.png --after m.png -o three.png --size 40 --height 20");
  CHECK_THAT(space.run("compare three.png m.png").err, Contains("136 x 20 with 3 channels"));
  space.must("view --flat -t m.png --after m.png --after m.png -o flat.png --size 64");
  CHECK_THAT(space.run("compare flat.png m.png").err, Contains("208 x 64 with 3 channels"));
  space.must("view --flat -t m.png -o same.png --size 32");
  CHECK(space.run("compare same.png m.png --fail 200").code == 0);

  check_refused(space, "view --flat -o p.png", 2, "--texture is missing");
  check_refused(space, "view m.obj --flat -t m.png -o p.png", 2, "m.obj");
  check_refused(space, "view --flat -t m.png --zoom 2 -o p.png", 2, "--flat and --zoom");
  check_refused(space, "view --flat -t m.png --wireframe -o p.png", 2, "--flat and --wireframe");
  check_refused(space, "view m.obj -t m.png --after no.png -o p.png", 4, "no.png: ");
  check_refused(space, "view m.obj --face-materials --after m.png -o p.png", 2, "exclude");
  check_refused(space, "view m.obj --wrap border -o p.png", 2, "--wrap");
}
