// How the program takes meshes in pieces that were meant to be one.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/image/image_io.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// Two unit squares side by side: one quad and three, with a texture of two colours.
std::string two_squares(const std::string& right) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
         "v " +
         right + " 0 0\nv 2 0 0\nv " + right +
         " 0.34 0\nv 2 0.34 0\n"
         "v " +
         right + " 0.67 0\nv 2 0.67 0\nv " + right +
         " 1 0\nv 2 1 0\n"
         "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nvt 1 0\nvt 0.5 0.17\nvt 1 0.17\n"
         "vt 0.5 0.335\nvt 1 0.335\nvt 1 0.5\n"
         "f 1/1 2/2 3/3 4/4\nf 5/2 6/5 8/7 7/6\nf 7/6 8/7 10/9 9/8\nf 9/8 10/9 12/10 11/3\n";
}

struct Squares : Workspace {
  explicit Squares(const std::string& right) {
    file("m.obj", two_squares(right));
    must("make-mesh plane -o plane.obj -t t.png --size 64");
  }
};

}  // namespace

TEST_CASE("filter and info count what they join", "[tools][joining]") {
  const Squares space("1.00");
  const auto plan = space.must("filter m.obj -t t.png --dry-run --json").json();
  CHECK(plan["plan"]["joined_edges"] == 3);
  CHECK(plan["plan"]["t_junctions"] == 2);
  CHECK(plan["warnings"].empty());
  const auto run = space.must("filter m.obj -t t.png -o o.png --json").json();
  CHECK(run["counts"]["joined_edges"] == 3);
  CHECK(run["counts"]["t_junctions"] == 2);
  const auto info = space.must("info m.obj -t t.png --json").json();
  CHECK(info["joined_edges"] == 3);
  CHECK(info["t_junctions"] == 2);
  CHECK(info["components"] == 1);
  CHECK_THAT(space.must("info m.obj -t t.png").out, Contains("3 edges apart by rounding, 2 T"));
  const auto apart = space.must("info m.obj -t t.png --json --weld 0").json();
  CHECK(apart["joined_edges"] == 0);
  CHECK(apart["near_boundary_edges"] > 0);
}

TEST_CASE("gaps within a texel are named with the option that closes them", "[tools][joining]") {
  const Squares space("1.0200");
  const auto json = space.must("filter m.obj -t t.png --dry-run --json").json();
  REQUIRE(json["warnings"].size() == 1);
  CHECK_THAT(json["warnings"][0].get<std::string>(),
             Contains("boundary edges lie within a texel of others but stay apart; --weld 0.021 "
                      "would join them"));
  const auto closed = space.must("filter m.obj -t t.png --dry-run --json --weld 0.021").json();
  CHECK(closed["warnings"].empty());
  CHECK(closed["plan"]["joined_edges"] == 3);
  const auto info = space.must("info m.obj -t t.png --json").json();
  bool advised = false;
  for (const auto& line : info["advice"])
    advised = advised || line.get<std::string>().find("--weld 0.021 would") != std::string::npos;
  CHECK(advised);
  CHECK_THAT(space.must("filter m.obj -t t.png -o o.png --bridge 0.001").err,
             Contains("nothing was bridged"));
}

TEST_CASE("texels have no say in what is welded", "[tools][joining]") {
  const Squares space("1.00");
  for (const char* command :
       {"filter m.obj -t t.png -o o.png", "info m.obj", "map m.obj -t t.png -o o.exr",
        "distance m.obj --vertex 0", "sample m.obj -o o.ply --spacing 0.1", "refine m.obj",
        "compare t.png t.png --mesh m.obj --material all"}) {
    check_refused(space, std::string(command) + " --weld 2tx", 2, "--weld: is in mesh units");
    check_refused(space, std::string(command) + " --weld -1", 2, "--weld");
    CHECK(space.run(std::string(command) + " --weld 0.01%").code == 0);
  }
}

TEST_CASE("map and sample name the file's faces where those were split", "[tools][joining]") {
  const Squares space("1.00");
  space.must("map m.obj -t t.png -o map.exr");
  const Image map = read_image(space / "map.exr");
  const int face = channel(map, "face"), b0 = channel(map, "b0"), x = channel(map, "x"),
            y = channel(map, "y");
  int seen = 0;
  for (Index i = 0; i < Index(map.width * map.height); ++i) {
    const float* texel = map.texel(i);
    CHECK(texel[face] < 8);
    if (texel[face] != 0) continue;
    // The first face has its corners at (0,0), (1,0) and (1,1).
    ++seen;
    CHECK(texel[b0] == Approx(1 - texel[x]).margin(1e-6));
    CHECK(texel[b0 + 1] == Approx(texel[x] - texel[y]).margin(1e-6));
  }
  CHECK(seen > 100);
  space.must("sample m.obj -o s.ply --spacing 0.05");
  const std::vector<double> faces = ply_columns(space / "s.ply")["face"];
  for (const double f : faces) CHECK(f < 8);
}

TEST_CASE("distances lead over what was joined and come back to the file's vertices",
          "[tools][joining]") {
  const Squares space("1.00");
  space.must("distance m.obj --vertex 10 -o d.ply");
  const auto columns = ply_columns(space / "d.ply");
  for (std::size_t v = 0; v < columns.at("x").size(); ++v) {
    const double dx = columns.at("x")[v] - 1, dy = columns.at("y")[v] - 1;
    CHECK(columns.at("distance")[v] == Approx(std::hypot(dx, dy)).margin(1e-5));
  }
}
