// What a texel means: light, alpha, layers, values that are missing.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "onmesh/image/image_io.h"
#include "onmesh/procedural/texture.h"

#include "support/run_program.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// A workspace with a square sheet.
struct Sheet : Workspace {
  Sheet() { must("make-mesh plane -o m.obj -t unused.png --size 8"); }
  Image read(const std::string& name) const { return read_image(*this / name); }
};

/// Columns of black and white by turns.
Image bars(int channels) {
  Image image = make_image(48, 48, channels);
  for (Index t = 0; t < 48 * 48; ++t) std::fill_n(image.texel(t), channels, t % 2 == 0 ? 0.F : 1.F);
  return image;
}

const std::string kBlur = " --kind gaussian --sigma-spatial 4tx --quiet";

/// What the program says about the colour space.
std::string space_of(const Sheet& space, const std::string& options) {
  const auto report = space.must("filter m.obj -o o.exr --json --dry-run " + options).json();
  return std::string(report["texture"]["colour_space"]) + ", " +
         std::string(report["texture"]["colour_space_reason"]);
}

/// The middle texel in 255ths.
long middle(const Image& image) { return std::lround(image.texel(24 * 48 + 24)[0] * 255); }

}  // namespace

TEST_CASE("light is averaged, as the colour space of each map says", "[tools][values]") {
  const Sheet space;
  write_image(space / "bars.png", bars(3), {false, 8});
  write_image(space / "grey.png", bars(1), {false, 8});
  write_image(space / "bars.exr", bars(3));
  space.must("filter m.obj -t bars.png -o o.png" + kBlur);
  CHECK(middle(space.read("o.png")) == 188);
  space.must("filter m.obj -t bars.png -o o.png --raw" + kBlur);
  CHECK(std::abs(middle(space.read("o.png")) - 127) <= 1);
  space.must("filter m.obj -t bars.png@data -o o.png" + kBlur);
  CHECK(std::abs(middle(space.read("o.png")) - 127) <= 1);
  space.must("filter m.obj -t grey.png@colour -o o.png" + kBlur);
  CHECK(middle(space.read("o.png")) == 188);

  CHECK(space_of(space, "-t bars.png") == "sRGB, the file's tag");
  CHECK(space_of(space, "-t grey.png") == "data, 1 channel");
  CHECK(space_of(space, "-t bars.exr") == "linear, the file's tag");
  CHECK(space_of(space, "-t bars.exr --colorspace srgb") == "sRGB, asked for");
  CHECK(space_of(space, "-t bars.png@data --colorspace Rec709") == "data, its role");
  CHECK_THAT(space.must("info m.obj -t bars.png").out, Contains("sRGB (the file's tag)"));

  check_refused(space, "filter m.obj -t bars.png -o x.png --colorspace aces", 3,
                "unknown colour space 'aces'");
  check_refused(space, "filter m.obj -t bars.png -o x.png --raw --colorspace sRGB", 2,
                "--raw: excludes");
  check_refused(space, "filter m.obj -t bars.png@normal -o x.png", 2, "unknown role '@normal'");
  check_refused(space, "filter m.obj -t bars.png -o x.png --range-space lab", 2, "--range-space");
  check_refused(space, "filter m.obj -t grey.png -o x.png --range-space oklab", 2,
                "--range-space: oklab is for three channels");
  check_refused(space, "filter m.obj -t bars.png -o x.png --kind gaussian --range-space log", 2,
                "only with --kind bilateral");
}

TEST_CASE("what else is in an EXR stays as it is", "[tools][values]") {
  const Sheet space;
  Image image = make_texture(32, 32, Pattern::checker, 0.2, 1, 5);
  image.channel_names = {"R", "G", "B", "depth.Z", "id.x"};
  for (Index t = 0; t < 32 * 32; ++t) image.texel(t)[4] = t % 32 < 16 ? 3.F : 700.F;
  write_image(space / "m.exr", image);
  const Run run = space.must("filter m.obj -t m.exr -o o.exr --kind gaussian --sigma-spatial 4tx");
  CHECK_THAT(run.err, Contains("the channels R G B are filtered, 2 others stay"));
  const Image result = space.read("o.exr"), before = space.read("m.exr");
  REQUIRE(result.channel_names == before.channel_names);
  const auto at = [&](const char* name) {
    return int(std::find(before.channel_names.begin(), before.channel_names.end(), name) -
               before.channel_names.begin());
  };
  double change = 0;
  for (Index t = 0; t < 32 * 32; ++t) {
    for (const char* const name : {"id.x", "depth.Z"})
      REQUIRE(result.texel(t)[at(name)] == before.texel(t)[at(name)]);
    change =
        std::max(change, std::abs(double(result.texel(t)[at("G")]) - before.texel(t)[at("G")]));
  }
  CHECK(change > 0.1);
  space.must("filter m.obj -t m.exr -o d.exr --layer depth" + kBlur);
  CHECK(space.read("d.exr").texel(0)[at("G")] == before.texel(0)[at("G")]);
  CHECK(space.read("d.exr").texel(0)[at("depth.Z")] != before.texel(0)[at("depth.Z")]);
  check_refused(space, "filter m.obj -t m.exr -o x.exr --layer diffuse", 3,
                "m.exr: it has no layer 'diffuse'; it has depth, id");
}

TEST_CASE("a cut-out keeps its colour, and values that are missing are counted",
          "[tools][values]") {
  const Sheet space;
  Image leaf = make_image(48, 48, 4);
  leaf.alpha_channel = 3;
  for (Index t = 0; t < 48 * 48; ++t) {
    const bool inside = t % 48 >= 12 && t % 48 < 36;
    const float colour[] = {inside ? 200 / 255.F : 0, inside ? 160 / 255.F : 0,
                            inside ? 40 / 255.F : 0, inside ? 1.F : 0};
    std::copy_n(colour, 4, leaf.texel(t));
  }
  write_image(space / "leaf.png", leaf, {false, 8});
  space.must("filter m.obj -t leaf.png -o o.png" + kBlur);
  CHECK(space.read("o.png").pixels == space.read("leaf.png").pixels);

  Image holes = make_texture(48, 48, Pattern::checker, 0.2, 2, 3);
  holes.texel(500)[1] = NAN;
  holes.texel(900)[0] = INFINITY;
  write_image(space / "holes.exr", holes);
  const Run run = space.must("filter m.obj -t holes.exr -o o.exr");
  CHECK_THAT(run.err, Contains("2 texels on the surface had values that are not finite"));
  const Image filled = space.read("o.exr");
  for (const float v : filled.pixels) REQUIRE(std::isfinite(v));
}

TEST_CASE("colour spaces of an OpenColorIO configuration are known by their names",
          "[tools][values]") {
  const Sheet space;
  write_image(space / "bars.png", bars(3), {false, 8});
  // Codes are square roots of light.
  space.file("config.ocio",
             "ocio_profile_version: 1\n"
             "roles: {default: lin, reference: lin, scene_linear: lin}\n"
             "displays:\n  screen:\n    - !<View> {name: plain, colorspace: lin}\n"
             "colorspaces:\n  - !<ColorSpace>\n    name: lin\n"
             "  - !<ColorSpace>\n    name: Paint\n"
             "    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n");
  setenv("OCIO", (space / "config.ocio").c_str(), 1);
  space.must("filter m.obj -t bars.png -o o.png --colorspace paint" + kBlur);
  check_refused(space, "filter m.obj -t bars.png -o x.png --colorspace nonsense", 3,
                "and those of $OCIO");
  space.must("filter m.obj -t bars.png -o own.png" + kBlur);
  unsetenv("OCIO");
  CHECK(std::abs(middle(space.read("o.png")) - 180) <= 1);
  CHECK(middle(space.read("own.png")) == 188);  // sRGB is known without any
}
