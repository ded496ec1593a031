// Meshes whose material files are as people bring them, through the program.
#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/image/image_io.h"
#include "support/paths.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// A copy of one of the cases that users sent.
struct Case : Workspace {
  explicit Case(const std::string& name) {
    const std::filesystem::path folder = shared_data() / "cases" / name;
    is_there = std::filesystem::is_directory(folder);
    if (!is_there) {
      WARN("skipped: " << folder.string() << " is not there");
      return;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      std::filesystem::copy_file(entry.path(), *this / entry.path().filename().string());
  }
  bool is_there = false;
};

const std::string kOptions = " --kind gaussian --sigma-spatial 4tx --threads 1 ";

/// For large textures.
const std::string kCheap = " --kind gaussian --sigma-spatial 1tx --threads 1 ";

/// A square of the model's material, with UVs from `low` to `high`.
std::string square(const std::string& low, const std::string& high) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt " + low + " " + low + "\nvt " + high + " " + low +
         "\nvt " + high + " " + high + "\nvt " + low + " " + high +
         "\nusemtl m\nf 1/1 2/2 3/3 4/4\n";
}

}  // namespace

TEST_CASE("a clamped material filters as with --wrap clamp", "[tools][materials]") {
  const Case space("02-mtl-clamp");
  if (!space.is_there) return;
  space.must("filter model.obj -o out.png" + kOptions);
  space.must("filter model.obj -o twin.png --wrap clamp" + kOptions);
  CHECK(content_of(space / "out.png") == content_of(space / "twin.png"));
  const Image before = read_image(space / "tex.png"), after = read_image(space / "out.png");
  int changed = 0;
  for (int y = 0; y < before.height; ++y)
    for (int x = 0; x <= 12; ++x)
      for (int c = 0; c < before.channels; ++c) {
        const Index texel = Index(y * before.width + x);
        changed += before.texel(texel)[c] != after.texel(texel)[c];
      }
  CHECK(changed == 0);
  // What the command line says goes before what the material does.
  space.must("filter model.obj -o repeated.png --wrap repeat" + kOptions);
  CHECK(content_of(space / "out.png") != content_of(space / "repeated.png"));
}

TEST_CASE("scale and offset of a material's texture count", "[tools][materials]") {
  const Case space("02b-real-texture-parameters");
  if (!space.is_there) return;
  // Four squares of 256 x 256 texels: once, moved, 2 x 3 times, and both.
  const auto plan = space.must("filter texture_parameters.obj -o o.png --dry-run --json").json();
  CHECK(plan["plan"]["texels"] == (1 + 1 + 6 + 6) * 256 * 256);
  const auto info = space.must("info texture_parameters.obj --json").json();
  CHECK(info["uv_max"][0].get<double>() == Approx(2.1));
  CHECK(info["uv_max"][1].get<double>() == Approx(3.2));
  space.must(
      "view texture_parameters.obj --no-light --up y --azimuth 0 --elevation 0 --size 200 "
      "-o view.png");
}

TEST_CASE("a lost material file is why there is no texture", "[tools][materials]") {
  const Case space("03-mtllib-missing");
  if (!space.is_there) return;
  const Run filtered = space.run("filter model.obj -o out.png" + kOptions);
  CHECK(filtered.code == 2);
  CHECK_THAT(filtered.err, Contains("scan_export.mtl: cannot open"));
  const Run info = space.must("info model.obj");
  CHECK_THAT(info.out, !Contains("filter will take it") && Contains("filter will refuse it") &&
                           Contains("scan_export.mtl: cannot open"));
  const auto json = space.must("info model.obj --json").json();
  CHECK(json["filterable"] == false);
  CHECK_THAT(json["refusal"].get<std::string>(), Contains("no texture"));
  CHECK(space.must("info model.obj -t tex.png --json").json()["filterable"] == true);
}

TEST_CASE("comments behind names of material files and materials are left out",
          "[tools][materials]") {
  const Case space("05b-real-comments");
  if (!space.is_there) return;
  space.must("filter 'cube with white spaces.obj' -o out.png" + kCheap);
  space.must("filter cube_with_materials_comments.obj -o out2.png" + kCheap);
  CHECK(read_image(space / "out.png").pixels == read_image(space / "out2.png").pixels);
}

TEST_CASE("names in the other case of letters are found, with a note", "[tools][materials]") {
  const Case space("06-name-case");
  if (!space.is_there) return;
  space.must("filter twin.obj -o twin.png" + kOptions);
  for (const std::string number : {"", "2", "3"}) {
    const Run run =
        space.must("filter model" + number + ".obj -o out" + number + ".png" + kOptions);
    CHECK(content_of(space / ("out" + number + ".png")) == content_of(space / "twin.png"));
    CHECK_THAT(run.err, Contains("differs in the case of letters"));
  }
}

TEST_CASE("a material file beside the OBJ stands in for one in a lost folder",
          "[tools][materials]") {
  const Case space("07b-real-mtllib-folder");
  if (!space.is_there) return;
  const auto json =
      space.must("filter box-resources-in-root.obj -o out.png --json" + kCheap).json();
  CHECK(json["texture"]["path"] == "cesium.png");
}

TEST_CASE("confined, every command stays within the mesh's folder", "[tools][materials]") {
  const Workspace space;
  space.must("make-mesh plane -o unused.obj -t t.png --size 16");
  std::filesystem::create_directory(space / "model");
  space.file("model/m.mtl", "newmtl m\nmap_Kd ../t.png\n");
  space.file("model/m.obj", "mtllib m.mtl\n" + square("0", "1"));
  CHECK_THAT(space.must("filter model/m.obj -o o.png").err,
             Contains("lies outside the mesh's folder"));
  const std::string reason = "'../t.png' lies outside the mesh's folder";
  for (const std::string command :
       {"filter model/m.obj -o p.png", "info model/m.obj", "map model/m.obj -o p.exr",
        "view model/m.obj -o p.png", "sample model/m.obj -o p.ply", "refine model/m.obj",
        "distance model/m.obj --vertex 0 --radius 1", "compare t.png t.png --mesh model/m.obj"}) {
    check_refused(space, command + " --confine", 3, reason);
  }
  // Tiles are only known once the UVs are; links of theirs do not lead out either.
  space.file("model/m.mtl", "newmtl m\nmap_Kd t.<UDIM>.png\n");
  std::filesystem::create_symlink("../t.png", space / "model/t.1001.png");
  space.must("filter model/m.obj -o o.1001.png");
  check_refused(space, "filter model/m.obj -o p.1001.png --confine", 3, "lies outside");
  // What the command line names may lie anywhere.
  space.must("filter model/m.obj -t t.png -o o.png --confine");
}

TEST_CASE("a mirrored texture filters as its two halves on one sheet", "[tools][materials]") {
  const Workspace space;
  space.must("make-mesh plane -o unused.obj -t t.png --size 32");
  space.file("m.obj", square("0", "2"));
  space.must("filter m.obj -t t.png -o mirrored.png --wrap mirror" + kOptions);
  // The image and its turned copies, in each direction.
  const Image image = read_image(space / "t.png");
  const int n = image.width;
  Image large = make_image(2 * n, 2 * n, image.channels);
  for (int y = 0; y < 2 * n; ++y)
    for (int x = 0; x < 2 * n; ++x) {
      // Rows run down and v up: the image itself is at the bottom.
      const int column = x < n ? x : 2 * n - 1 - x, row = y >= n ? y - n : n - 1 - y;
      std::copy_n(image.texel(Index(row * n + column)), image.channels,
                  large.texel(Index(y * 2 * n + x)));
    }
  write_image(space / "large.png", large);
  space.file("once.obj", square("0", "1"));
  space.must("filter once.obj -t large.png -o all.png" + kOptions);
  const Image got = read_image(space / "mirrored.png"), all = read_image(space / "all.png");
  double most = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      for (int c = 0; c < image.channels; ++c) {
        most = std::max(most, std::abs(double(got.texel(Index(y * n + x))[c]) -
                                       double(all.texel(Index((y + n) * 2 * n + x))[c])));
      }
  CHECK(most <= 1.01 / 255);  // rounding of the files
}
