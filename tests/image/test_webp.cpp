// WebP in and out.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"

using namespace onmesh;
using Catch::Contains;

namespace {

Image eight_bit_noise(int width, int height, int channels) {
  Image image = noise(width, height, channels);
  for (float& value : image.pixels) value = std::round(value * 255) / 255;
  if (channels == 4) image.alpha_channel = 3;
  return image;
}

/// A lossless WebP of RGBA texels.
std::string webp_bytes() { return encode_image("a.webp", eight_bit_noise(24, 20, 4)); }

}  // namespace

TEST_CASE("a WebP holds 8-bit colours without losses", "[webp]") {
  const ImageFolder folder;
  for (const int channels : {3, 4}) {
    const Image image = eight_bit_noise(33, 17, channels);
    std::vector<std::string> warnings;
    write_image(folder / "a.webp", image, {.bits = 8}, &warnings);
    CHECK(warnings.empty());
    const Image again = read_image(folder / "a.webp", &warnings);
    CHECK(warnings.empty());
    CHECK(again.channels == channels);
    CHECK(again.alpha_channel == image.alpha_channel);
    CHECK(same_bits(again.pixels, image.pixels));
    write_image(folder / "b.webp", again);
    CHECK(slurp(folder / "b.webp") == slurp(folder / "a.webp"));
    write_image(folder / "c.png", again, {}, &warnings);
    CHECK(warnings.empty());
    CHECK(same_bits(read_image(folder / "c.png").pixels, image.pixels));
  }
}

TEST_CASE("a WebP keeps colours without opacity, and alpha that is opaque everywhere", "[webp]") {
  const ImageFolder folder;
  for (const float alpha : {0.0F, 1.0F}) {
    Image image = eight_bit_noise(9, 7, 4);
    for (Index i = 0; i < 9 * 7; ++i) image.texel(i)[3] = alpha;
    write_image(folder / "a.webp", image);
    const Image again = read_image(folder / "a.webp");
    CHECK(again.channels == 4);
    CHECK(same_bits(again.pixels, image.pixels));
  }
}

TEST_CASE("a lossy WebP is read as other programs read it and written without losses", "[webp]") {
  const ImageFolder folder;
  OIIO::ImageSpec spec(40, 30, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("compression", "webp:80");
  write_by_library(folder / "a.webp", {spec});
  const Image image = read_image(folder / "a.webp");
  const std::vector<float> expected = pixels_by_library(folder / "a.webp");
  REQUIRE(image.pixels.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    REQUIRE(image.pixels[i] == Approx(expected[i]).margin(1e-6));
  write_image(folder / "b.webp", image);
  CHECK(same_bits(read_image(folder / "b.webp").pixels, image.pixels));
}

TEST_CASE("a WebP keeps colour profile and metadata of a WebP", "[webp]") {
  const ImageFolder folder;
  const auto chunk = [](const std::string& name, const std::string& content) {
    return name + little(std::uint32_t(content.size())) + content;
  };
  const std::string exif = std::string("II*\0", 4) + little(std::uint32_t(8)) +
                           little(std::uint16_t(1)) + little(std::uint16_t(0x112)) +
                           little(std::uint16_t(3)) + little(std::uint32_t(1)) +
                           little(std::uint32_t(3)) + little(std::uint32_t(0));
  const std::string picture = webp_bytes().substr(12);
  const std::string header = std::string("\x3c\0\0\0", 4) + std::string("\x17\0\0\x13\0\0", 6);
  const std::string chunks = "WEBP" + chunk("VP8X", header) + chunk("ICCP", "profile.") + picture +
                             chunk("EXIF", exif) + chunk("XMP ", "<x:xmpmeta/>");
  dump(folder / "a.webp", "RIFF" + little(std::uint32_t(chunks.size())) + chunks);
  std::vector<std::string> warnings;
  const Image image = read_image(folder / "a.webp", &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("orientation tag 3"));
  write_image(folder / "b.webp", image);
  CHECK(slurp(folder / "b.webp") == slurp(folder / "a.webp"));
}

TEST_CASE("what a WebP cannot hold is refused before it is written", "[webp]") {
  const ImageFolder folder;
  CHECK_THROWS_WITH(check_writable_image(folder / "a.webp", make_image(4, 4, 1)),
                    Contains("webp cannot hold 1 channels"));
  CHECK_THROWS_WITH(check_writable_image(folder / "a.webp", make_image(16384, 1, 3)),
                    Contains("webp cannot hold sides"));
  std::vector<std::string> warnings;
  Image image = make_image(2, 2, 3);
  image.pixels[0] = 1.5F;
  write_image(folder / "a.webp", image, {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("1 values outside [0,1]"));
  CHECK(read_image(folder / "a.webp").pixels[0] == 1);
}

TEST_CASE("a WebP cut short or with sizes that are not so is refused", "[webp]") {
  const ImageFolder folder;
  const std::string bytes = webp_bytes();
  for (const std::size_t length : {12, 16, 20, 25, 40, int(bytes.size()) - 1}) {
    INFO("cut to " << length);
    dump(folder / "a.webp", bytes.substr(0, length));
    CHECK_THROWS_AS(read_image(folder / "a.webp"), InputError);
    // The same with a size that fits: then pixels are missing.
    std::string whole = bytes.substr(0, length);
    whole.replace(4, 4, little(std::uint32_t(length - 8)));
    dump(folder / "b.webp", whole);
    CHECK_THROWS_AS(read_image(folder / "b.webp"), InputError);
  }
  std::string longer = bytes;
  longer.replace(16, 4, little(std::uint32_t(0xfffffff0)));
  dump(folder / "a.webp", longer);
  CHECK_THROWS_WITH(read_image(folder / "a.webp"), Contains("a chunk of the WebP is longer"));
}

TEST_CASE("an animated WebP is refused by that name", "[webp]") {
  const ImageFolder folder;
  const std::string header = std::string("\x02\0\0\0", 4) + std::string("\x17\0\0\x13\0\0", 6);
  const auto chunk = [](const std::string& name, const std::string& content) {
    return name + little(std::uint32_t(content.size())) + content;
  };
  const std::string chunks = "WEBP" + chunk("VP8X", header) + chunk("ANIM", std::string(6, '\0')) +
                             chunk("ANMF", std::string(6, '\0') + header.substr(4) +
                                               std::string(4, '\0') + webp_bytes().substr(12));
  dump(folder / "a.webp", "RIFF" + little(std::uint32_t(chunks.size())) + chunks);
  CHECK_THROWS_WITH(read_image(folder / "a.webp"), Contains("a.webp") && Contains("animation"));
}
