// What compare measures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "onmesh/base/file_io.h"
#include "onmesh/image/image_io.h"
#include "onmesh/procedural/texture.h"
#include "support/gltf_builder.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("compare finds the worst texel and fails below the asked PSNR",
          "[tools][compare][slow]") {
  const Workspace space;
  Image a = make_image(8, 4, 3), b = a;
  b.texel(2 * 8 + 5)[1] = 0.5F;
  write_image(space / "a.exr", a);
  write_image(space / "b.exr", b);
  const double psnr = -10 * std::log10(0.25 / (8 * 4 * 3));
  const auto json = space.must("compare a.exr b.exr --json --fail 20").json();
  CHECK(json["psnr"].get<double>() == Approx(psnr));
  CHECK(json["max"] == 0.5);
  CHECK(json["worst_texel"] == nlohmann::json{5, 2});
  CHECK(json["texels"] == 32);
  CHECK(json["passed"] == true);
  CHECK_THAT(space.must("compare a.exr b.exr").out, Contains("column 5, row 2"));

  const Run failed = space.run("compare a.exr b.exr --fail 60 --json");
  CHECK(failed.code == 1);
  CHECK(failed.json()["passed"] == false);
  CHECK_THAT(failed.err, Contains("below --fail 60"));

  const auto equal = space.must("compare a.exr a.exr --fail 100 --json").json();
  CHECK(equal["equal"] == true);
  CHECK(equal["psnr"].is_null());  // infinite
  write_image(space / "wide.exr", make_image(9, 4, 3));
  const Run wide = space.run("compare a.exr wide.exr");
  CHECK(wide.code == 3);
  CHECK_THAT(wide.err, Contains("wide.exr") && Contains("a.exr"));
}

TEST_CASE("compare with a mesh looks at covered texels and seams only", "[tools][compare][slow]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj -t a.png --size 64");
  Image b = read_image(space / "a.png");
  const auto map = space.must("map m.obj -t a.png -o map.exr --json").json();
  const Image where = read_image(space / "map.exr");
  const int coverage = channel(where, "coverage");
  Index outside = 0;
  while (where.texel(outside)[coverage] != 0) ++outside;
  b.texel(outside)[0] = b.texel(outside)[0] > 0.5F ? 0.0F : 1.0F;
  write_image(space / "b.png", b);
  CHECK(space.run("compare a.png b.png --fail 90").code == 1);
  const auto json = space.must("compare a.png b.png --mesh m.obj --fail 90 --json").json();
  CHECK(json["equal"] == true);
  CHECK(json["texels"] == map["covered"]);
  CHECK(json["seams_a"]["edges"].get<int>() > 0);
  CHECK(json["seams_a"] == json["seams_b"]);
}

TEST_CASE("compare of glTF files is that of their images on their mesh", "[tools][compare][gltf]") {
  const Workspace space;
  const auto png = [&](Pattern pattern, int size, const std::string& name) {
    write_image(space / name, make_texture(size, size, pattern, 0.3, 1, 3), {false, 8});
    return read_file(space / name);
  };
  const auto write_glb = [&](const std::string& name, const std::vector<std::string>& images) {
    GltfBuilder gltf;
    for (const std::string& image : images) {
      const int mesh = gltf.add_square(gltf.add_material(image, "m"));
      gltf.add_node({{"mesh", mesh}, {"translation", {0, 0, double(mesh)}}});
    }
    space.file(name, gltf.glb());
  };
  const std::string one = png(Pattern::checker, 16, "a.png"),
                    other = png(Pattern::noise, 16, "b.png");
  write_glb("a.glb", {one});
  write_glb("b.glb", {other});
  auto images = space.must("compare a.png b.png --mesh a.glb --json").json();
  for (const std::string arguments : {"", " --mesh a.glb", " --mesh b.glb"}) {
    INFO(arguments);
    auto json = space.must("compare a.glb b.glb --json" + arguments).json();
    CHECK(json["files"][0]["a"] == "a.glb/image0.png");
    CHECK(json["files"][0]["b"] == "b.glb/image0.png");
    CHECK(json["psnr"].get<double>() > 0);
    for (const char* const key : {"psnr", "max", "texels", "worst_texel", "seams_a", "seams_b"})
      CHECK(json[key] == images[key]);
  }
  CHECK(space.run("compare a.glb b.glb --fail 90").code == 1);
  CHECK(space.must("compare a.glb a.glb --json --fail 90").json()["equal"] == true);

  write_glb("two.glb", {one, other});
  write_glb("turned.glb", {other, one});
  CHECK(space.must("compare two.glb turned.glb --json").json()["files"].size() == 2);
  check_refused(space, "compare a.glb two.glb", 3, "two.glb: has 2 images, a.glb has 1");
  write_glb("wide.glb", {png(Pattern::checker, 32, "wide.png")});
  check_refused(space, "compare a.glb wide.glb", 3, "wide.glb/image0.png: 32 x 32");
  GltfBuilder named;
  named.add_node({{"mesh", named.add_square(named.add_material(one, "m"))}});
  named.json["images"][0]["name"] = "wood";
  space.file("named.glb", named.glb());
  check_refused(space, "compare a.glb named.glb", 3,
                "named.glb: has no image image0.png, as a.glb");
  check_refused(space, "compare a.glb b.glb --slot normal", 2, "no texture");
}

TEST_CASE("compare takes textures of which some have alpha", "[tools][compare][gltf]") {
  const Workspace space;
  const auto png = [&](Pattern pattern, int channels, const std::string& name) {
    write_image(space / name, make_texture(16, 16, pattern, 0.3, 1, channels), {false, 8});
    return read_file(space / name);
  };
  const auto write_glb = [&](const std::string& name, const std::vector<std::string>& images) {
    GltfBuilder gltf;
    for (const std::string& image : images)
      gltf.add_node({{"mesh", gltf.add_square(gltf.add_material(image, "m"))}});
    space.file(name, gltf.glb());
  };
  const std::string opaque = png(Pattern::checker, 3, "a.png"),
                    clear = png(Pattern::checker, 4, "b.png"),
                    grey = png(Pattern::checker, 1, "c.png");
  write_glb("a.glb", {opaque, clear});
  const auto json = space.must("compare a.glb a.glb --json").json();
  CHECK(json["equal"] == true);
  CHECK(json["files"].size() == 2);
  CHECK(json["seams_a"]["rms"] == json["seams_b"]["rms"]);
  // Grey and colours cannot be compared across a seam.
  write_glb("g.glb", {opaque, grey});
  const Run run = space.run("compare g.glb g.glb --json");
  CHECK(run.code == 0);
  CHECK(run.json()["seams_a"].is_null());
  CHECK_THAT(run.err, Contains("different channels"));
}

TEST_CASE("compare measures light, alpha apart, where a mask shows it", "[tools][compare]") {
  const Workspace space;
  space.must("make-mesh plane -o m.obj -t unused.png --size 8");
  Image a = make_image(8, 8, 4);
  a.alpha_channel = 3;
  a.channel_names = {"R", "G", "B", "A"};
  std::fill(a.pixels.begin(), a.pixels.end(), 1.F);
  Image b = a;
  for (Index t = 0; t < 64; ++t) {
    b.texel(t)[3] = 0.5F;
    // Half of the texels, which a mask of another size hides.
    if (t / 8 >= 4) std::fill_n(b.texel(t), 3, 3.F);
  }
  write_image(space / "a.exr", a);
  write_image(space / "b.exr", b);
  Image mask = make_image(2, 2, 1);
  mask.pixels = {1, 1, 0, 0};
  write_image(space / "half.png", mask, {false, 8});
  for (const std::string mesh : {"", " --mesh m.obj --material all"}) {
    const auto whole = space.must("compare a.exr b.exr --json" + mesh).json();
    CHECK(whole["texels"] == 64);
    CHECK(whole["light"]["rel_mse"].get<double>() == Approx(0.5 * 4 / 9.01));
    CHECK(whole["light"]["alpha"]["rel_mse"].get<double>() == Approx(0.25 / 0.26));
    Image shown = make_image(8, 8, 1);
    for (Index t = 0; t < 64; ++t) shown.pixels[t] = t / 8 < 4 ? 1.F : 0.F;
    write_image(space / "mask.png", shown, {false, 8});
    const auto half = space.must("compare a.exr b.exr --json --mask mask.png" + mesh).json();
    CHECK(half["texels"] == 32);
    CHECK(half["light"]["rel_mse"] == 0);
    CHECK(half["light"]["log_psnr"].is_null());  // infinite
    // Looked up between its texels: two rows more count in part.
    CHECK(space.must("compare a.exr b.exr --json --mask half.png" + mesh).json()["texels"] == 48);
  }
  const Run text = space.must("compare a.exr b.exr");
  CHECK_THAT(text.out, Contains("relMSE") && Contains("logPSNR") && Contains("alpha relMSE"));

  // Codes are decoded as filter would: the default of 8 bits is sRGB.
  Image white = make_image(4, 4, 3), grey = white;
  std::fill(white.pixels.begin(), white.pixels.end(), 1.F);
  std::fill(grey.pixels.begin(), grey.pixels.end(), 188.F / 255);
  write_image(space / "w.png", white, {false, 8});
  write_image(space / "g.png", grey, {false, 8});
  const auto rel_mse = [&](const std::string& options) {
    return space.must("compare g.png w.png --json" + options)
        .json()["light"]["rel_mse"]
        .get<double>();
  };
  CHECK(rel_mse("") == Approx(0.2472 / 1.01).epsilon(0.002));
  CHECK(rel_mse(" --raw") == Approx(std::pow(67.0 / 255, 2) / 1.01));
  const Run none = space.run("compare g.png w.png --mask gone.png");
  CHECK(none.code == 4);
}
