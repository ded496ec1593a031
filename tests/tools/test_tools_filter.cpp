// filter and sample from end to end.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "onmesh/image/image_io.h"
#include "support/paths.h"
#include "support/run_program.h"

using namespace onmesh;
using Catch::Contains;

namespace {

std::vector<float> pixels_of(const Image& image) { return image.pixels; }

/// Whether the process runs the program already, and has set up its own handling of SIGINT.
bool catches_interrupts(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process);
  std::error_code error;
  if (!std::filesystem::equivalent(folder + "/exe", program(), error)) return false;
  std::ifstream status(folder + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("SigCgt:", 0) != 0) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
  }
  return false;
}

}  // namespace

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
  CHECK(json["seams_b"]["rms"].get<double>() < 0.5 * json["seams_a"]["rms"].get<double>());
  // Beyond charts and gutter nothing changes.
  space.must("map m.obj -o map.exr --quiet");
  const Image map = read_image(space / "map.exr");
  const Image before = read_image(space / "m.png"), after = read_image(space / "o.png");
  const auto& names = map.channel_names;
  const auto coverage = std::find(names.begin(), names.end(), "coverage") - names.begin();
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

TEST_CASE("an interrupted run leaves the target as it was and nothing else behind",
          "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 1024");
  space.file("o.png", "what was there before");
  const auto files = space.files();
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const std::string mesh = (space / "m.obj").string(), out = (space / "o.png").string();
    // Far more work than the time until the signal.
    ::execl(program().c_str(), "onmesh", "filter", mesh.c_str(), "-o", out.c_str(), "--quiet",
            "--sigma-spatial", "30tx", nullptr);
    ::_exit(99);
  }
  const auto wait = [](int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  };
  for (int i = 0; i < 6000 && !catches_interrupts(child); ++i) wait(10);
  wait(700);
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(space.files() == files);
  CHECK(content_of(space / "o.png") == "what was there before");
}

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
  CHECK(count > 50);
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

TEST_CASE("a filter and its samples are measured by the commands that follow", "[tools][filter]") {
  const Workspace space;
  space.must("make-mesh noisy-cube -o m.obj -t m.png --size 96");
  space.must("filter m.obj -o texel.png --sigma-spatial 4tx --quiet");
  space.must("filter m.obj -o poisson.png --sigma-spatial 4tx --samples poisson --quiet");
  const Run close = space.run("compare texel.png poisson.png --mesh m.obj --fail 25");
  INFO(close.out);
  CHECK(close.code == 0);
  CHECK(space.run("compare texel.png m.png --mesh m.obj --fail 40").code == 1);
}
