// onmesh fill, as a user runs it.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/image/image_io.h"
#include "onmesh/procedural/texture.h"
#include "support/images.h"
#include "support/run_program.h"
#include "tools/tool_checks.h"

using namespace onmesh;
using Catch::Contains;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Sheet : Workspace {
  Sheet() { must("make-mesh plane -o m.obj -t unused.png --size 8"); }
  Image read(const std::string& name) const { return read_image(*this / name); }
};

/// Left to right from 0 to 1, with a hole in the middle whose texels have that value.
Image ramp(int channels, float hole) {
  Image image = make_image(32, 32, channels);
  for (Index t = 0; t < 32 * 32; ++t) {
    const int x = int(t % 32), y = int(t / 32);
    const bool missing = x >= 8 && x < 24 && y >= 8 && y < 24;
    std::fill_n(image.texel(t), channels, missing ? hole : float(x) / 31);
  }
  return image;
}

/// The largest difference from the ramp.
double error_of(const Image& image) {
  double worst = 0;
  for (Index t = 0; t < 32 * 32; ++t)
    worst = std::max(worst, std::abs(double(image.texel(t)[0]) - double(t % 32) / 31));
  return worst;
}

}  // namespace

TEST_CASE("fill gives texels without a value one, all others stay", "[tools][fill]") {
  const Sheet space;
  const Image holed = ramp(1, kNan);
  write_image(space / "nan.exr", holed);
  const auto report = space.must("fill m.obj -t nan.exr -o o.exr --json --quiet").json();
  CHECK(report["counts"]["missing"] == 256);
  CHECK(report["counts"]["left"] == 0);
  const Image result = space.read("o.exr");
  CHECK(error_of(result) < 1e-3);
  for (Index t = 0; t < 32 * 32; ++t)
    if (std::isfinite(holed.pixels[t])) REQUIRE(result.pixels[t] == holed.pixels[t]);

  // The same hole by a mask, of another size.
  write_image(space / "black.exr", ramp(1, 0));
  Image mask = make_image(16, 16, 1);
  for (Index t = 0; t < 16 * 16; ++t) {
    const bool missing = t % 16 >= 3 && t % 16 < 13 && t / 16 >= 3 && t / 16 < 13;
    mask.pixels[t] = missing ? 0.F : 1.F;
  }
  write_image(space / "mask.png", mask, {false, 8});
  space.must("fill m.obj -t black.exr -o o.exr --mask-samples mask.png --quiet");
  CHECK(error_of(space.read("o.exr")) < 1e-3);
}

TEST_CASE("alpha 0 is missing if that is said, and alpha is filled with the colour",
          "[tools][fill]") {
  const Sheet space;
  Image photo = ramp(4, 0);
  for (Index t = 0; t < 32 * 32; ++t)
    photo.texel(t)[3] = photo.texel(t)[0] == 0 && t % 32 != 0 ? 0.F : 1.F;
  photo.alpha_channel = 3;
  photo.channel_names = {"R", "G", "B", "A"};
  write_image(space / "p.png", photo, {false, 8});
  const std::string raw = " --raw --quiet";
  space.must("fill m.obj -t p.png -o o.png --missing alpha" + raw);
  const Image result = space.read("o.png");
  CHECK(error_of(result) < 0.01);
  for (Index t = 0; t < 32 * 32; ++t) REQUIRE(result.texel(t)[3] == 1);

  // Not asked for there is nothing to do.
  space.must("fill m.obj -t p.png -o same.png" + raw);
  CHECK(has_same_pixels(space.read("p.png"), space.read("same.png")));

  write_image(space / "rgb.png", ramp(3, 0), {false, 8});
  check_refused(space, "fill m.obj -t rgb.png -o x.png --missing alpha", 3, "there is no alpha");
  write_image(space / "none.exr", make_image(8, 8, 1));
  Image all = make_image(8, 8, 1);
  write_image(space / "zero.png", all, {false, 8});
  check_refused(space, "fill m.obj -t none.exr -o x.exr --mask-samples zero.png", 3,
                "no texel on the surface has a value");
  check_refused(space, "fill m.obj -t none.exr -o x.exr --missing black", 2, "--missing");
  check_refused(space, "fill m.obj -t none.exr -o x.exr --mask-samples gone.png", 4, "gone.png");
}

TEST_CASE("fill with many threads gives the same bytes", "[tools][fill]") {
  const Sheet space;
  Image image = make_texture(200, 200, Pattern::checker, 0.2, 3, 3);
  for (Index t = 0; t < 200 * 200; ++t)
    if (t % 7 < 3 || (t / 200 > 50 && t / 200 < 120)) image.texel(t)[0] = kNan;
  write_image(space / "m.exr", image);
  space.must("fill m.obj -t m.exr -o one.exr --threads 1 --quiet");
  space.must("fill m.obj -t m.exr -o four.exr --threads 4 --quiet");
  CHECK(has_same_pixels(space.read("one.exr"), space.read("four.exr")));
}
