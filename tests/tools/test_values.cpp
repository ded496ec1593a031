// What a texel means: light, alpha, layers, values that are missing.
#include <algorithm>
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

TEST_CASE("masks say what is taken and what counts", "[tools][values]") {
  const Sheet space;
  // Lit but for a block that something stands on: black, and not valid.
  Image lit = make_image(32, 32, 3), mask = make_image(32, 32, 1);
  for (Index t = 0; t < 32 * 32; ++t) {
    const bool hidden = t % 32 > 10 && t % 32 < 20 && t / 32 > 10 && t / 32 < 20;
    std::fill_n(lit.texel(t), 3, hidden ? 0.F : 0.7F);
    mask.pixels[t] = hidden ? 0.F : 1.F;
  }
  write_image(space / "ao.png", lit, {false, 8});
  write_image(space / "mask.png", mask, {false, 8});
  const Image before = space.read("ao.png");
  const std::string blur = " -t ao.png --kind gaussian --sigma-spatial 3tx";
  const Run run = space.must("filter m.obj -o o.png --mask mask.png" + blur);
  CHECK_THAT(run.err, Contains("81 texels that the mask leaves out are black"));
  CHECK(has_same_pixels(before, space.read("o.png")));
  const auto report =
      space.must("filter m.obj -o o.png --mask-samples mask.png --json --quiet" + blur).json();
  CHECK(report["counts"]["left_out_texels"] == 81);
  const Image filled = space.read("o.png");
  for (Index t = 0; t < 32 * 32; ++t) REQUIRE(filled.texel(t)[0] == before.texel(0)[0]);
  space.must("filter m.obj -o o.png --strength 0" + blur);
  CHECK(has_same_pixels(before, space.read("o.png")));

  Image alpha = make_image(4, 4, 1);
  alpha.channel_names = {"A"};
  write_image(space / "alpha.exr", alpha);
  check_refused(space, "filter m.obj -o x.png --mask alpha.exr" + blur, 3, "alpha.exr");
  check_refused(space, "filter m.obj -o x.png --mask none.png" + blur, 4, "none.png");
  check_refused(space, "filter m.obj -o x.png --strength 2" + blur, 2, "--strength: 2 is not");
  check_refused(space, "filter m.obj -o x.png --alpha" + blur, 3, "there is no alpha");
}

TEST_CASE("detail and output give the texture again", "[tools][values]") {
  const Sheet space;
  const Image image = make_texture(32, 32, Pattern::checker, 0.2, 3, 3);
  for (const int bits : {8, 16}) {
    write_image(space / "m.png", image, {false, bits});
    space.must("filter m.obj -t m.png -o o.png --detail-out d.exr" + kBlur);
    const Image before = space.read("m.png"), out = space.read("o.png"), d = space.read("d.exr");
    const double levels = bits == 8 ? 255 : 65535;
    for (std::size_t k = 0; k < before.pixels.size(); ++k)
      REQUIRE(std::lround((double(out.pixels[k]) + d.pixels[k]) * levels) ==
              std::lround(before.pixels[k] * levels));
  }
  write_image(space / "m.exr", image);
  space.must("filter m.obj -t m.exr -o o.exr --detail-out sub/ " + kBlur);
  const Image out = space.read("o.exr"), d = space.read("sub/m.exr");
  for (std::size_t k = 0; k < out.pixels.size(); ++k) {
    // Within the last place of the larger one: the difference has no more bits than that.
    const float again = out.pixels[k] + d.pixels[k], was = image.pixels[k];
    const float large = std::max(std::abs(was), std::abs(out.pixels[k]));
    REQUIRE(std::abs(again - was) <= std::nextafter(large, 2.F) - large);
  }
  space.must("filter m.obj -t m.png -o o.png --detail-gain 1" + kBlur);
  CHECK(has_same_pixels(space.read("m.png"), space.read("o.png")));
  check_refused(space, "filter m.obj -t m.png -o o.png --detail-out d.png", 2,
                "--detail-out: d.png: differences need 32-bit float");
  check_refused(space, "filter m.obj -t m.png -o o.png --detail-out d.exr --detail-gain 2", 2,
                "--detail-out and --detail-gain exclude each other");
  check_refused(space, "filter m.obj -t m.exr -o o.exr --detail-out o.exr", 2,
                "is the output or the mesh");
}

TEST_CASE("info advises by names, which decide nothing", "[tools][values]") {
  const Sheet space;
  const Image image = make_texture(16, 16, Pattern::checker, 0.2, 3, 3);
  for (const char* name : {"wall_ROUGH.png", "wall_n.png", "wall.png", "tan.png"})
    write_image(space / name, image, {false, 8});
  const auto advice = [&](const std::string& texture) {
    return std::string(space.must("info m.obj -t " + texture + " --json").json()["advice"].dump());
  };
  CHECK_THAT(advice("wall_ROUGH.png"), Contains("give -t wall_ROUGH.png@data"));
  CHECK_THAT(advice("wall_ROUGH.png@data"), !Contains("map of numbers"));
  CHECK_THAT(advice("wall_n.png"), Contains("normal map"));
  CHECK_THAT(advice("wall.png") + advice("tan.png"), !Contains("has the name of"));
  CHECK(space_of(space, "-t wall_ROUGH.png") == "sRGB, the file's tag");
}
