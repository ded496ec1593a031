// filter from end to end.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "onmesh/image/image_io.h"
#include "support/paths.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

std::vector<float> pixels_of(const Image& image) { return image.pixels; }

/// Mean square of the difference between neighbours in a row.
double roughness(const Image& image) {
  double squares = 0;
  for (Index y = 0; y < Index(image.height); ++y)
    for (Index x = 1; x < Index(image.width); ++x)
      for (int c = 0; c < image.channels; ++c) {
        const Index texel = y * Index(image.width) + x;
        const double step = double(image.texel(texel)[c]) - double(image.texel(texel - 1)[c]);
        squares += step * step;
      }
  return squares / double(image.pixels.size());
}

}  // namespace

TEST_CASE("filter refuses parameters outside their domain with 2", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t m.png --size 16");
  const std::string base = "filter m.obj -o o.png ";
  const std::string positive = ": must be positive and finite\n";
  check_refused(space, base + "--sigma-spatial 0", 2, "--sigma-spatial");
  check_refused(space, base + "--sigma-spatial -1", 2, "--sigma-spatial");
  check_refused(space, base + "--sigma-spatial nan", 2, "--sigma-spatial");
  check_refused(space, base + "--sigma-range 0", 2,
                "--sigma-range: \"0\" is not a positive number");
  check_refused(space, base + "--sigma-range nan", 2, "--sigma-range");
  check_refused(space, base + "--radius 0", 2, "--radius");
  check_refused(space, base + "--gutter -1", 2, "--gutter");
  check_refused(space, base + "--kind box", 2, "--kind");
  check_refused(space, base + "--node-spacing 1e-9", 2, "--node-spacing: would make about");
  check_refused(space, base + "--tolerance 0", 2, "onmesh filter: --tolerance" + positive);
  check_refused(space, base + "--samples poisson --r-coef 0", 2, "filter: --r-coef" + positive);
  check_refused(space, base + "--r-coef 1", 2, "filter: --r-coef: only with --samples poisson\n");
  check_refused(space, base + "--samples poisson --r-coef 1 --spacing 1", 2,
                "onmesh filter: --spacing and --r-coef exclude each other\n");
  check_refused(space, base + "--bridge 0.1 --distance exact", 2,
                "--bridge: exact distances know none, so not with --distance exact\n");
  check_refused(space, base + "--overlap both", 2, "--overlap");
  check_refused(space, base + "--sigma-spacial 1", 2, "did you mean --sigma-spatial?");
  check_refused(space, "filter m.obj", 2, "--output");
}

TEST_CASE("filter speaks of flags where the library speaks of fields", "[tools][filter]") {
  const Workspace space;
  // Two squares on one half of the atlas, and beside the image's own tile.
  space.file("m.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\n"
             "vt 1 0\nvt 2 0\nvt 2 0.5\nvt 1 0.5\n"
             "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/1 6/2 7/3\nf 5/1 7/3 8/4\n");
  space.must("make-mesh plane -o unused.obj -t m.png --size 16");
  const std::string base = "filter m.obj -t m.png -o o.png ";
  const std::string claimed = "128 texels are claimed by several places";
  check_refused(space, base + "--overlap error", 3, "filter: --overlap error: " + claimed);
  const Run average = space.must(base + "--json");
  CHECK_THAT(average.err, Contains(claimed) && Contains("(--overlap average)\n") &&
                              Contains("or cut off with --wrap clamp\n"));
  const auto warnings = average.json()["warnings"];
  REQUIRE(warnings.size() == 2);
  CHECK_THAT(warnings[0].get<std::string>(), Contains("--wrap clamp"));
  CHECK_THAT(warnings[1].get<std::string>(), Contains("(--overlap average)"));
  const auto plan = space.must(base + "--overlap first --dry-run --quiet --json").json();
  CHECK_THAT(plan["warnings"][1].get<std::string>(), Contains("(--overlap first)"));
}

TEST_CASE("errors and findings name faces as in the file", "[tools]") {
  const Workspace space;
  // The first face has a vertex twice and is left out; the UVs of the third span too many tiles.
  space.file("m.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 40000\n"
             "f 1/1 2/2 2/2\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  space.must("make-mesh plane -o unused.obj -t m.png --size 16");
  const std::string reason = "m.obj: face 2: its UVs span more than 16384 tiles\n";
  check_refused(space, "filter m.obj -t m.png -o o.png", 3, reason);
  check_refused(space, "map m.obj --resolution 8x8 -o m.exr", 3, reason);
  check_refused(space, "compare m.png m.png --mesh m.obj", 3, reason);
  check_refused(space, "sample m.obj --resolution 8x8 -o s.ply", 3, reason);
  check_refused(space, "distance m.obj --vertex 0 --resolution 8x8 --texture d.exr", 3, reason);
  CHECK(space.must("info m.obj --resolution 8x8 --json").json()["textures"][0]["error"] ==
        "face 2: its UVs span more than 16384 tiles");
}

TEST_CASE("a constant texture stays as it is, bit for bit", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj -t m.png --size 48");
  Image image = read_image(space / "m.png");
  std::fill(image.pixels.begin(), image.pixels.end(), 77.0F / 255);
  write_image(space / "m.png", image);
  for (const std::string kind : {"bilateral", "gaussian"}) {
    space.must("filter m.obj -o o.png --sigma-spatial 3tx --quiet --kind " + kind);
    CHECK(pixels_of(read_image(space / "o.png")) == pixels_of(image));
  }
}

TEST_CASE("filtering brings both sides of the seams together and keeps the rest of the image",
          "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 96");
  space.must("filter m.obj -o o.png --sigma-spatial 3tx --sigma-range 0.5 --quiet");
  const auto json = space.must("compare m.png o.png --mesh m.obj --json").json();
  CHECK(json["equal"] == false);
  CHECK(json["seams_b"]["rms"].get<double>() < 0.3 * json["seams_a"]["rms"].get<double>());
  // Beyond charts and gutter nothing changes.
  space.must("map m.obj -o map.exr --quiet");
  const Image map = read_image(space / "map.exr");
  const Image before = read_image(space / "m.png"), after = read_image(space / "o.png");
  const int coverage = channel(map, "coverage");
  const int reach = 4;  // more than the gutter's two rings
  Index untouched = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      bool near = false;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const int row = (y + dy + map.height) % map.height;
          const int column = (x + dx + map.width) % map.width;
          near |= map.texel(Index(row * map.width + column))[coverage] != 0;
        }
      }
      if (near) continue;
      ++untouched;
      const Index i = Index(y * map.width + x);
      CHECK(std::equal(before.texel(i), before.texel(i) + 3, after.texel(i)));
    }
  }
  CHECK(untouched > 0);
}

TEST_CASE("the result is the same for any number of threads", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 128");
  std::string first;
  for (const std::string threads : {"1", "2", "7"}) {
    space.must("filter m.obj -o o.png --sigma-spatial 4tx --quiet --threads " + threads);
    const std::string bytes = content_of(space / "o.png");
    if (first.empty()) first = bytes;
    CHECK(bytes == first);
  }
}

TEST_CASE("the texture may be filtered in place", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 64");
  space.must("filter m.obj -o apart.png --quiet");
  const auto files = space.files();
  space.must("filter m.obj -t m.png -o m.png --quiet");
  CHECK(content_of(space / "m.png") == content_of(space / "apart.png"));
  CHECK(space.files() == files);
}

TEST_CASE("a dry run tells what would be done and writes nothing", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 64");
  const auto files = space.files();
  const Run run = space.must("filter m.obj -o o.png --dry-run");
  CHECK_THAT(run.out, Contains("sigma"));
  CHECK(space.must("filter m.obj -o o.png --dry-run --json").json()["dry_run"] == true);
  CHECK(space.files() == files);
}

TEST_CASE("filter --json reports what was done under fixed names", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 64");
  const Run run = space.must("filter m.obj -o o.png --sigma-spatial 0.1 --json");
  const auto json = run.json();
  for (const char* name : {"onmesh", "command", "mesh", "texture", "output", "options", "backend",
                           "counts", "stages", "warnings", "seconds", "peak_memory_bytes"}) {
    INFO(name);
    CHECK(json.contains(name));
  }
  CHECK(json["options"]["sigma-spatial"] == "0.1");
  CHECK(json["lengths"]["sigma_spatial"].get<double>() == Approx(0.1));
  CHECK(json["lengths"]["radius"].get<double>() == Approx(0.25));
  const auto map = space.must("map m.obj -o map.exr --json").json();
  CHECK(json["counts"]["texels"] == map["covered"]);
}

TEST_CASE("a filter and its samples are measured by the commands that follow", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 96");
  space.must("filter m.obj -o texel.png --sigma-spatial 4tx --quiet");
  space.must("filter m.obj -o poisson.png --sigma-spatial 4tx --samples poisson --quiet");
  const Run close = space.run("compare texel.png poisson.png --mesh m.obj --fail 55");
  INFO(close.out);
  CHECK(close.code == 0);
  CHECK(space.run("compare texel.png m.png --mesh m.obj --fail 40").code == 1);
}

TEST_CASE("a cube as loose triangles gives the bytes of the cube", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube --segments 3 -o m.obj -t m.png --size 128");
  space.must("make-mesh noisy-cube --segments 3 --soup -o soup.obj");
  const auto soup = space.must("info soup.obj --json").json();
  CHECK(soup["vertices_in_file"] == 3 * soup["faces"].get<int>());
  space.must("filter m.obj -o a.png --sigma-spatial 3tx --quiet");
  space.must("filter soup.obj -t m.png -o b.png --sigma-spatial 3tx --quiet");
  CHECK(content_of(space / "a.png") == content_of(space / "b.png"));
}

TEST_CASE("real meshes that are not manifold are filtered, or told why not", "[tools][filter]") {
  const std::filesystem::path folder = shared_data();
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  const Workspace space;
  const Run flag =
      space.run("filter '" + (folder / "kenney_flag/flag.obj").string() + "' -o o.png");
  CHECK(flag.code == 3);
  CHECK_THAT(flag.err, Contains("no face have any area") && Contains("nothing to filter"));
  space.must("make-mesh plane -o m.obj -t small.png --size 128 --noise 0.2");
  const Image texture = read_image(space / "small.png");
  for (const char* file :
       {"milk_truck/milk_truck.obj", "spider/spider.obj", "cup_scan/textured-0008192.obj"}) {
    INFO(file);
    const Run run = space.must("filter '" + (folder / file).string() +
                               "' -t small.png --material all -o o.exr --json");
    const Image image = read_image(space / "o.exr");
    bool within = true;
    for (const float v : image.pixels) within = within && v >= 0 && v <= 1;
    CHECK(within);
    // The charts of the scan are too small beside these texels to be smoothed.
    if (std::string(file).rfind("cup", 0) != 0) CHECK(roughness(image) < 0.9 * roughness(texture));
    const bool tie = std::string(file).rfind("milk", 0) == 0;
    CHECK((run.err.find("2 vertices join parts that share no edge") != std::string::npos) == tie);
    CHECK(run.json()["counts"]["texels"] > 1000);
  }
}

TEST_CASE("the plan bounds nodes and memory within twice what is used", "[tools][filter][slow]") {
  const Workspace space;
  for (const std::string name :
       {"book", "chest", "folded-sheet", "noisy-cube", "plane", "sphere", "u-sheet"}) {
    for (const std::string options :
         {"", " --kind gaussian --sigma-spatial 8tx", " --distance heat", " --samples poisson"}) {
      const std::string command = "filter " + (source_folder() / "meshes" / name).string() +
                                  ".obj -o o.exr --json --quiet" + options;
      const auto plan = space.must(command + " --dry-run").json()["plan"];
      const auto report = space.must(command).json();
      const double nodes = report["counts"]["nodes"], memory = report["peak_memory_bytes"];
      const double expected_nodes = plan["estimated_nodes"];
      const double expected_memory = plan["estimated_memory_bytes"];
      CAPTURE(command, nodes, expected_nodes, memory, expected_memory);
      CHECK(nodes <= expected_nodes);
      CHECK(expected_nodes <= 2 * nodes);
      CHECK(memory <= expected_memory);
      CHECK(expected_memory <= 2 * memory);
    }
  }
}
