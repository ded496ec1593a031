#include "onmesh/image/colour_space.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/temp_folder.h"

namespace onmesh {
namespace {

float to_linear(const std::string& space, float code) {
  find_colour_space(space)->to_linear(&code, 1, 1);
  return code;
}

/// An image as a file of that kind gives it.
Image from_file(const std::string& name, int channels, bool as_float) {
  const TempFolder folder;
  Image image = make_image(2, 2, channels);
  if (channels == 2 || channels == 4) image.alpha_channel = channels - 1;
  write_image(folder.path() / name, image, {as_float, as_float ? 0 : 8});
  return read_image(folder.path() / name);
}

ColourSpaceChoice choice(const Image& image, const ColourSpaceRequest& request = {}) {
  return choose_colour_space(image, request);
}

}  // namespace

TEST_CASE("transfer functions are those of their standards", "[colour_space]") {
  // IEC 61966-2-1, ITU-R BT.709: half the light.
  CHECK(to_linear("sRGB", 188 / 255.F) == Approx(0.5029).epsilon(1e-3));
  CHECK(to_linear("sRGB", 0.04F) == Approx(0.04 / 12.92));
  CHECK(to_linear("srgb", 1) == Approx(1));
  CHECK(to_linear("Rec709", 0.7055F) == Approx(0.5).epsilon(1e-3));
  CHECK(to_linear("Rec709", 0.045F) == Approx(0.01));
  CHECK(to_linear("Gamma2.2", 0.5F) == Approx(std::pow(0.5, 2.2)));
  CHECK(to_linear("sRGB", -0.5F) == Approx(-to_linear("sRGB", 0.5F)));
  for (const char* const none : {"linear", "raw", "data", "Linear"})
    CHECK(find_colour_space(none) == nullptr);
  for (const char* const wrong : {"", "sRGBx", "Gamma", "Gamma-1", "Gamma1e9", "GammaX"})
    CHECK_THROWS_AS(find_colour_space(wrong), InputError);
}

TEST_CASE("linear light goes back to the code it came from", "[colour_space]") {
  for (const char* const name : {"sRGB", "Rec709", "Gamma1.8"}) {
    const auto space = find_colour_space(name);
    for (int code = 0; code < 65536; ++code) {
      float value = float(code) / 65535;
      space->to_linear(&value, 1, 1);
      space->from_linear(&value, 1, 1);
      REQUIRE(std::lround(value * 65535) == code);
    }
  }
}

TEST_CASE("a colour space is chosen by what is known best", "[colour_space]") {
  using Role = ColourSpaceRequest::Role;
  const Image colours = from_file("a.png", 3, false), grey = from_file("a.png", 1, false),
              light = from_file("a.exr", 3, true), plain = from_file("a.tif", 3, true),
              made = make_image(2, 2, 3);
  CHECK(choice(colours).name == "sRGB");
  CHECK(choice(colours).space != nullptr);
  CHECK(choice(grey).name == "data");
  CHECK(choice(grey).space == nullptr);
  CHECK(choice(light).name == "linear");
  CHECK(choice(plain).reason == "floats");
  CHECK(choice(made).space == nullptr);

  ColourSpaceRequest request;
  request.slot_is_data = true;
  CHECK(choice(colours, request).name == "data");
  request.name = "Rec709";
  CHECK(choice(colours, request).name == "Rec709");
  CHECK(choice(grey, request).name == "Rec709");
  request.role = Role::data;
  CHECK(choice(colours, request).name == "data");
  CHECK(choice(colours, request).has_no_alpha);
  // "Colour" says only that it is not data.
  request = {};
  request.role = Role::colour;
  CHECK(choice(grey, request).name == "sRGB");
  CHECK(choice(light, request).name == "linear");
  request.name = "raw";
  CHECK(choice(grey, request).name == "raw");
}

TEST_CASE("only files that say so hold colours multiplied with alpha", "[colour_space]") {
  CHECK(is_premultiplied(from_file("a.exr", 4, true)));
  CHECK_FALSE(is_premultiplied(from_file("a.png", 4, false)));
  CHECK_FALSE(is_premultiplied(from_file("a.exr", 3, true)));
  CHECK_FALSE(is_premultiplied(make_image(2, 2, 4)));
}

TEST_CASE("ACEScg is linear light of other primaries", "[colour_space]") {
  const auto space = find_colour_space("acescg");
  REQUIRE(space);
  float values[] = {0.25F, -1, 7};
  space->to_linear(values, 1, 3);
  CHECK(values[2] == 7);
  REQUIRE(space->to_rec709() != nullptr);
  // White stays white.
  for (int row = 0; row < 3; ++row) {
    const float* const m = space->to_rec709() + 3 * row;
    CHECK(m[0] + m[1] + m[2] == Approx(1).margin(1e-4));
  }
  CHECK(find_colour_space("sRGB")->to_rec709() == nullptr);
}

}  // namespace onmesh
