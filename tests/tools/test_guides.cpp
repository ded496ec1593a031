// Guides, map sets and presets as users give them.
#include <catch2/catch.hpp>
#include <filesystem>

#include "onmesh/image/image_io.h"
#include "support/images.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// A sheet with two textures of one size and one of another.
struct Sheet : Workspace {
  Sheet() {
    must("make-mesh plane -o m.obj -t albedo.png --size 64");
    write_image(*this / "rough.png", pattern(64), {false, 8});
    write_image(*this / "small.png", pattern(32), {false, 8});
  }

  static Image pattern(int size) {
    Image image = make_image(size, size, 1);
    for (Index t = 0; t < Index(size * size); ++t) image.pixels[t] = float((t * 7919) % 256) / 255;
    return image;
  }
  Image read(const std::string& name) const { return read_image(*this / name); }
};

const std::string kThreeMaps =
    "filter m.obj -t albedo=albedo.png -t rough=rough.png@data -t small=small.png@data "
    "-o 'out/{map}.{ext}' ";

}  // namespace

TEST_CASE("a set of maps is filtered by one guide, and written whole", "[tools][guides]") {
  const Sheet space;
  const auto report = space.must(kThreeMaps + "--guide albedo:0.1 --json --quiet").json();
  REQUIRE(report["textures"].size() == 3);
  CHECK(report["textures"][1]["map"] == "rough");
  CHECK(report["textures"][1]["colour_space"] == "data");
  for (const char* name : {"out/albedo.png", "out/rough.png", "out/small.png"})
    CHECK(space.has(name));
  // What guides itself is the plain bilateral filter of it.
  space.must("filter m.obj -t albedo.png -o plain.png --sigma-range 0.1 --quiet");
  CHECK(largest_difference(space.read("plain.png"), space.read("out/albedo.png")) < 1.5 / 255);
  // Without a guide that says which texels are alike there is nothing to go by.
  std::filesystem::remove_all(space / "out");
  check_refused(space, kThreeMaps, 2, "several maps need one that says which texels are alike");
  space.must(kThreeMaps + "--kind gaussian --quiet");
}

TEST_CASE("a guide that is the texture gives the plain filter's bytes", "[tools][guides]") {
  const Sheet space;
  std::filesystem::copy_file(space / "albedo.png", space / "copy.png");
  const auto filtered = [&](const std::string& options) {
    space.must("filter m.obj -t albedo.png -o o.png --quiet " + options);
    return content_of(space / "o.png");
  };
  const std::string plain = filtered("--sigma-range 0.15");
  CHECK(filtered("--guide self:0.15") == plain);
  CHECK(filtered("--guide copy.png:0.15") == plain);
  CHECK(filtered("--guide copy.png:0.15 --raw") == filtered("--sigma-range 0.15 --raw"));
  CHECK(filtered("--guide none") == filtered("--kind gaussian"));
}

TEST_CASE("presets are printed, and options given explicitly win", "[tools][guides]") {
  const Sheet space;
  CHECK_THAT(space.must("filter m.obj -t rough.png --preset ao --dry-run").out,
             Contains("preset        ao: --sigma-spatial 4tx"));
  const auto report =
      space
          .must("filter m.obj -t rough.png -o o.png --preset ao --sigma-spatial 2tx --json --quiet")
          .json();
  CHECK(report["options"]["sigma-spatial"] == "2tx");
  CHECK(report["options"]["radius"] == "8tx");
  CHECK(report["options"]["guide"].size() == 3);
  CHECK(report["range"]["noise"].get<double>() > 0.1);
  const auto blur =
      space.must("filter m.obj -t albedo.png -o o.png --preset blur --json --quiet").json();
  CHECK(blur["options"]["kind"] == "gaussian");
  // Of three channels, but numbers.
  const auto data =
      space.must("filter m.obj -t albedo.png -o o.png --preset ao --json --quiet").json();
  CHECK(data["texture"]["colour_space"] == "data");
}

TEST_CASE("a normal map guides and stays as it is", "[tools][guides]") {
  const Sheet space;
  space.must(
      "filter m.obj -t a=rough.png -t n=albedo.png@normal-gl -o 'out/{map}.png' "
      "--guide n:0.2 --quiet");
  CHECK(space.has("out/a.png"));
  CHECK_FALSE(space.has("out/n.png"));
}

TEST_CASE("what is wrong about guides and maps is said in one line", "[tools][guides]") {
  const Sheet space;
  const auto refused = [&](const std::string& options, const char* reason, int code = 2) {
    check_refused(space, "filter m.obj -t a=albedo.png -o o.png " + options, code, reason);
  };
  refused("--guide b:0.1", "there is no guide or file 'b'; there are self");
  refused("--guide self", "is not NAME:S");
  refused("--guide self:0", "is not a positive number");
  refused("--guide self:blur=2tx", "has no width at its end");
  refused("--guide surface-position:2n", "is not a positive length");
  refused("--guide self@data:0.1", "neither role nor UVs");
  refused("--guide none --guide self:1", "excludes other guides");
  refused("--guide self:0.1 --sigma-range 0.1", "--sigma-range");
  refused("--guide self:0.1 --kind gaussian", "--kind bilateral");
  refused("--guide rough.png@normal-gl:0.1", "normals have three", 3);
  refused("--guide rough.png@uv1:0.1", "is for glTF");
  refused("--guide rough.png@paint:0.1", "unknown role '@paint'");
  refused("-t rough.png", "all have a name: MAP=FILE");
  refused("-t self=rough.png", "'self' is a guide's name");
  refused("-t n=albedo.png@normal-gl", "it may be a guide");
  refused("-t b=rough.png --guide self:1", "several maps");
  refused("-t b=rough.png --guide a:1", "would both be written");
  refused("--guide rough.png@colour:0.1 --range-space oklab", "oklab is for three channels");
  refused("--preset photo", "'photo' is not one of lightmap, ao");
  refused("--iterations 0", "--iterations");
  refused("--guides-from result", "--iterations of 2 or more");
  refused("--despike 0.5", "--despike");
  refused("--despike-to limit", "only with --despike");
}

TEST_CASE("presets clean bakes, and leave clean ones as they are", "[tools][guides][slow]") {
  const std::filesystem::path bakes = shared_data() / "bakes";
  if (!std::filesystem::exists(bakes)) {
    WARN("skipped: no ../shared/data");
    return;
  }
  const Workspace space;
  /// dB over the texels that were baked, of values or of log(1 + x) in light.
  const auto cleaned = [&](const char* folder, const char* mesh, const char* texture,
                           const char* reference, const char* preset) {
    const std::string in = (bakes / folder).string() + "/";
    space.must("filter " + in + mesh + " -t " + in + texture + " -o o.exr --quiet --preset " +
               preset);
    return space
        .must("compare o.exr " + in + reference + " --mesh " + in + mesh + " --mask " + in +
              "coverage.png --json")
        .json();
  };
  const auto occlusion = [&](const char* texture) {
    return cleaned("ao", "gear.obj", texture, "ao_ref.exr", "ao");
  };
  CHECK(occlusion("ao_noisy_4spp.exr")["psnr"].get<double>() > 31.5);
  CHECK(occlusion("ao_ref.exr")["psnr"].get<double>() > 40);
  const auto light = [&](const char* texture) {
    return cleaned("lightmap", "scene_lightmap.obj", texture, "lightmap_ref.exr", "lightmap");
  };
  const auto at_16 = light("lightmap_noisy_16spp.exr"), at_4 = light("lightmap_noisy_4spp.exr");
  CHECK(at_16["light"]["log_psnr"].get<double>() > 29);
  CHECK(at_16["light"]["rel_mse"].get<double>() < 0.0171);
  CHECK(at_4["light"]["log_psnr"].get<double>() > 26.3);
  CHECK(at_4["light"]["rel_mse"].get<double>() < 0.027);
  CHECK(light("lightmap_ref.exr")["light"]["log_psnr"].get<double>() > 40);
  // Where the surface is smooth seams are no worse than other edges.
  const auto residual = at_16["seam_residual"];
  CHECK(residual["rms_at_seams"].get<double>() < 1.1 * residual["rms_inside"].get<double>());
}
