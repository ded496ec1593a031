// What commands say about images that are not as usual.
#include <catch2/catch.hpp>

#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("every command that reads a texture tells what is odd about its file",
          "[tools][odd_images][slow]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj -t m.png --size 64");
  OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", 6);
  write_by_library(space / "a.tif", {spec});
  const std::string line = "warning: a.tif: pixels are taken as they are stored";
  for (const std::string command :
       {"filter m.obj -t a.tif -o b.tif", "info m.obj -t a.tif", "compare a.tif a.tif",
        "view m.obj -t a.tif -o v.png", "map m.obj -t a.tif -o map.exr",
        "sample m.obj -t a.tif -o s.ply"}) {
    INFO(command);
    CHECK_THAT(space.must(command).err, Contains(line));
  }
  for (const std::string command :
       {"filter m.obj -t a.tif -o b.tif --json", "info m.obj -t a.tif --json"}) {
    INFO(command);
    const auto warnings = space.must(command).json()["warnings"];
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0].get<std::string>(), Contains("orientation tag 6"));
  }
  CHECK(spec_by_library(space / "b.tif").get_int_attribute("Orientation") == 6);
}

TEST_CASE("filter changes texels of a WebP and of an EXR's display window only",
          "[tools][odd_images][slow]") {
  const Workspace space;
  space.must("make-mesh cube -o m.obj -t m.png --size 64");
  write_image(space / "a.webp", read_image(space / "m.png"));
  space.must("filter m.obj -t a.webp -o b.webp");
  space.must("filter m.obj -t m.png -o b.png");
  CHECK(same_bits(read_image(space / "b.webp").pixels, read_image(space / "b.png").pixels));

  OIIO::ImageSpec spec(70, 80, 3, OIIO::TypeDesc::HALF);
  spec.x = spec.y = -4;
  spec.full_width = spec.full_height = 64;
  write_by_library(space / "a.exr", {spec});
  const std::vector<float> before = pixels_by_library(space / "a.exr");
  space.must("filter m.obj -t a.exr -o b.exr");
  const OIIO::ImageSpec written = spec_by_library(space / "b.exr");
  CHECK(written.x == -4);
  CHECK(written.height == 80);
  const std::vector<float> after = pixels_by_library(space / "b.exr");
  REQUIRE(after.size() == before.size());
  bool changed = false;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const int x = int(i / 3) % 70 - 4, y = int(i / 3) / 70 - 4;
    const bool is_texel = x >= 0 && x < 64 && y >= 0 && y < 64;
    if (!is_texel) REQUIRE(after[i] == before[i]);
    changed |= after[i] != before[i];
  }
  CHECK(changed);
}
