// What each format holds of an image.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "onmesh/image/image_io.h"
#include "support/image_files.h"

using namespace onmesh;

TEST_CASE("a tiled TIFF stays tiled and keeps its values", "[file_format]") {
  const ImageFolder folder;
  std::string data;
  for (int i = 0; i < 32 * 32 * 2; ++i) data += little(std::uint16_t(i * 31));
  dump(folder / "a.tif", make_tiff(20, 25, 2, 16, 1, data, "kept", 32));
  const Image image = read_image(folder / "a.tif");
  for (Index y = 0; y < 25; ++y)
    for (Index x = 0; x < 20; ++x)
      REQUIRE(image.texel(y * 20 + x)[1] == float((y * 32 + x) * 2 + 1) * 31 / 65535.0F);
  write_image(folder / "b.tif", image);
  CHECK(slurp(folder / "b.tif").find(std::string("\x42\x01\x03\0", 4)) != std::string::npos);
  CHECK(same_bits(image.pixels, read_image(folder / "b.tif").pixels));
  write_image(folder / "b.png", image);
  CHECK(same_bits(image.pixels, read_image(folder / "b.png").pixels));
}

TEST_CASE("an image from memory comes back as float from TIFF and EXR", "[file_format]") {
  const ImageFolder folder;
  for (const char* name : {"a.exr", "a.tif"}) {
    for (const int channels : {1, 2, 3, 4, 7}) {
      const Image image = noise(37, 300, channels);
      write_image(folder / name, image);
      const Image again = read_image(folder / name);
      CHECK(again.channels == channels);
      CHECK(same_bits(image.pixels, again.pixels));
    }
  }
}

TEST_CASE("channel names given in memory reach an EXR", "[file_format]") {
  const ImageFolder folder;
  Image image = noise(4, 4, 3);
  image.channel_names = {"face", "position.x", "position.y"};
  write_image(folder / "a.exr", image);
  CHECK(read_image(folder / "a.exr").channel_names == image.channel_names);
}

TEST_CASE("integer formats keep 8-bit values for every channel count they hold", "[file_format]") {
  const ImageFolder folder;
  const std::vector<std::pair<std::string, std::vector<int>>> cases = {
      {"a.png", {1, 2, 3, 4}}, {"a.tga", {1, 3, 4}}, {"a.bmp", {1, 3, 4}},
      {"a.ppm", {1, 3}},       {"a.sgi", {1, 3, 4}}, {"a.tif", {1, 2, 3, 4, 5}}};
  for (const auto& [name, counts] : cases) {
    for (const int channels : counts) {
      INFO(name << " with " << channels << " channels");
      Image image = noise(29, 31, channels);
      if (channels == 2 || channels == 4) image.alpha_channel = channels - 1;
      for (float& v : image.pixels) v = std::round(v * 255) / 255;
      write_image(folder / name, image, {.bits = 8});
      const Image again = read_image(folder / name);
      REQUIRE(again.channels == channels);
      CHECK(same_bits(image.pixels, again.pixels));
      CHECK(again.alpha_channel == image.alpha_channel);
      write_image(folder / name, again);
      CHECK(same_bits(image.pixels, read_image(folder / name).pixels));
    }
  }
}

TEST_CASE("float values in a PNG become 16 bit, clamped, with a warning", "[file_format]") {
  const ImageFolder folder;
  write_image(folder / "a.exr", noise(5, 5, 3));
  Image image = read_image(folder / "a.exr");
  image.pixels[0] = 1.5F;
  image.pixels[1] = -1;
  image.pixels[2] = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::string> warnings;
  write_image(folder / "a.png", image, {}, &warnings);
  const Image again = read_image(folder / "a.png");
  CHECK(slurp(folder / "a.png")[24] == 16);
  CHECK(again.pixels[0] == 1);
  CHECK(again.pixels[1] == 0);
  CHECK(again.pixels[2] == 0);
  for (std::size_t i = 3; i < image.pixels.size(); ++i)
    REQUIRE(std::abs(again.pixels[i] - image.pixels[i]) <= 0.5F / 65535 + 1e-7F);
  REQUIRE(warnings.size() == 3);
  CHECK(warnings[0].find("16-bit integers") != std::string::npos);
  CHECK(warnings[1].find("2 values outside [0,1]") != std::string::npos);
  CHECK(warnings[2].find("1 values that are not numbers") != std::string::npos);
}

TEST_CASE("forced float writes an 8-bit source as 32-bit float", "[file_format]") {
  const ImageFolder folder;
  write_image(folder / "a.png", noise(5, 5, 3), {.bits = 8});
  Image image = read_image(folder / "a.png");
  for (float& v : image.pixels) v += 1e-5F;
  write_image(folder / "a.tif", image, {.force_float = true});
  CHECK(same_bits(read_image(folder / "a.tif").pixels, image.pixels));
}
