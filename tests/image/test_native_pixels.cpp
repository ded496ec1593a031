// What pixels become on the way from a file to float values and back.

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "onmesh/image/image_io.h"
#include "support/image_files.h"

using namespace onmesh;

TEST_CASE("a half EXR keeps every bit pattern, names and metadata", "[native_pixels]") {
  const ImageFolder folder;
  const int width = 256, height = 256;
  std::vector<std::string> rows(height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) rows[std::size_t(y)] += little(std::uint16_t(y * 256 + x));
    for (int x = 0; x < width; ++x) rows[std::size_t(y)] += little(float(x) + 0.1F * float(y));
    for (int x = 0; x < width; ++x) rows[std::size_t(y)] += little(0xffffff00U + std::uint32_t(x));
  }
  const std::string file =
      make_exr(width, height, {{"a.height", 1}, {"b.depth", 2}, {"c.id", 0}}, rows);
  dump(folder / "a.exr", file);
  const Image image = read_image(folder / "a.exr");
  REQUIRE(image.channels == 3);
  CHECK(image.channel_names == std::vector<std::string>{"a.height", "b.depth", "c.id"});
  CHECK(image.texel(0x3c00)[0] == 1.0F);
  CHECK(image.texel(0x0001)[0] == 0x1p-24F);
  CHECK(image.texel(0xfc00)[0] == -std::numeric_limits<float>::infinity());
  CHECK(std::isnan(image.texel(0x7d01)[0]));
  CHECK(image.texel(257)[1] == 1.0F + 0.1F);
  write_image(folder / "b.exr", image);
  const std::string written = slurp(folder / "b.exr");
  // Uncompressed as the source was: the pixel data is the file's tail.
  const std::size_t tail = rows[0].size() * height + 8 * height;
  REQUIRE(written.size() > tail);
  CHECK(written.substr(written.size() - tail) == file.substr(file.size() - tail));
  CHECK(written.find("kept by the filter") != std::string::npos);
  CHECK(written.find("a.height") != std::string::npos);
}

TEST_CASE("changed values of an EXR are rounded to the nearest half", "[native_pixels]") {
  const ImageFolder folder;
  dump(folder / "a.exr", make_exr(4, 1, {{"Y", 1}}, {std::string(8, '\0')}));
  Image image = read_image(folder / "a.exr");
  image.pixels = {0.1F, 1.0F + 0x1p-11F, 1e9F, -0x1.8p-24F};
  write_image(folder / "b.exr", image);
  const Image again = read_image(folder / "b.exr");
  CHECK(again.pixels[0] == Approx(0.1F).epsilon(0x1p-11));
  CHECK(again.pixels[1] == 1.0F);       // a tie goes to even
  CHECK(again.pixels[2] == 65504.0F);   // the largest half rather than infinity
  CHECK(again.pixels[3] == -0x1p-23F);  // subnormal, a tie again
}

TEST_CASE("integers and doubles beyond float keep their own bits", "[native_pixels]") {
  const ImageFolder folder;
  std::mt19937_64 random(7);
  const auto check = [&](int bits, int sample_format) {
    std::string data;
    for (int i = 0; i < 8 * 5 * 3; ++i) {
      if (sample_format == 3)
        data += little(double(random()) / 1e19);
      else if (bits == 32)
        data += little(std::uint32_t(random()));
      else
        data += little(std::uint16_t(random()));
    }
    dump(folder / "a.tif", make_tiff(8, 5, 3, bits, sample_format, data));
    Image image = read_image(folder / "a.tif");
    image.texel(7)[1] = 0.5F;
    write_image(folder / "b.tif", image);
    const std::string written = slurp(folder / "b.tif");
    CHECK(written.find("kept") != std::string::npos);
    const std::size_t value = std::size_t(bits / 8), changed = (7 * 3 + 1) * value;
    std::string expected = data;
    if (sample_format == 3)
      expected.replace(changed, value, little(0.5));
    else if (bits == 32 && sample_format == 1)
      expected.replace(changed, value, little(0x80000000U));
    else if (bits == 32)
      expected.replace(changed, value, little(0x40000000));
    else if (sample_format == 1)
      expected.replace(changed, value, little(std::uint16_t(32768)));
    else
      expected.replace(changed, value, little(std::int16_t(16384)));
    INFO(bits << " bits of format " << sample_format);
    CHECK(written.find(expected) != std::string::npos);  // stored uncompressed, as it came
  };
  check(16, 1);
  check(16, 2);
  check(32, 1);
  check(32, 2);
  check(64, 3);
}

TEST_CASE("a float TIFF keeps values that are not finite", "[native_pixels]") {
  const ImageFolder folder;
  const std::vector<std::uint32_t> bits = {0x3f800000U, 0x7fc12345U, 0x7f812345U,
                                           0xff800000U, 0x00000001U, 0x80000000U};
  std::string data;
  for (const auto b : bits) data += little(b);
  dump(folder / "a.tif", make_tiff(3, 2, 1, 32, 3, data));
  const Image image = read_image(folder / "a.tif");
  for (std::size_t i = 0; i < bits.size(); ++i)
    CHECK(std::bit_cast<std::uint32_t>(image.pixels[i]) == bits[i]);
  write_image(folder / "b.tif", image);
  CHECK(same_bits(image.pixels, read_image(folder / "b.tif").pixels));
}
