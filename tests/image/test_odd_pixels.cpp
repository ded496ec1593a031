// Pixels that are stored in other ways than as 8 or 16 bit grey or RGB: what is read, and written.
#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"

using namespace onmesh;

TEST_CASE("PNGs of 1, 2 and 4 bits are grey of 8 bits", "[odd_pixels]") {
  const ImageFolder folder;
  for (const int bits : {1, 2, 4}) {
    INFO(bits << " bits");
    dump(folder / "a.png", make_png(8, 1, bits, 0, {std::string(std::size_t(bits), '\x1b')}));
    const Image image = read_image(folder / "a.png");
    REQUIRE(image.channels == 1);
    const int most = (1 << bits) - 1;
    for (int x = 0; x < 8; ++x) {
      const int byte = 0x1b, place = x * bits % 8;
      const int value = byte >> (8 - bits - place) & most;
      CHECK(image.pixels[std::size_t(x)] == float(value * (255 / most)) / 255.0F);
    }
    write_image(folder / "b.png", image);
    CHECK(slurp(folder / "b.png")[24] == 8);
    CHECK(same_bits(read_image(folder / "b.png").pixels, image.pixels));
  }
}

TEST_CASE("a PNG with a palette is its colours", "[odd_pixels]") {
  const ImageFolder folder;
  const std::string palette = png_chunk("PLTE", "\x10\x20\x30\xff\x40\x50");
  const std::string row("\0\1\1\0", 4);
  dump(folder / "a.png", make_png(4, 1, 8, 3, {row}, palette));
  const Image image = read_image(folder / "a.png");
  REQUIRE(image.channels == 3);
  CHECK(image.texel(0)[0] == 16 / 255.0F);
  CHECK(image.texel(1)[0] == 1);
  CHECK(image.texel(2)[2] == 0x50 / 255.0F);
  dump(folder / "b.png",
       make_png(4, 1, 8, 3, {row}, palette + png_chunk("tRNS", std::string("\x80", 1))));
  const Image clear = read_image(folder / "b.png");
  REQUIRE(clear.channels == 4);
  CHECK(clear.alpha_channel == 3);
  CHECK(clear.texel(0)[3] == 128 / 255.0F);
  CHECK(clear.texel(0)[0] == 16 / 255.0F);
  CHECK(clear.texel(1)[3] == 1);
}

TEST_CASE("grey with alpha has two channels in PNG and TIFF", "[odd_pixels]") {
  const ImageFolder folder;
  const std::string row("\x10\x00\x20\xff", 4);
  dump(folder / "a.png", make_png(2, 1, 8, 4, {row}));
  const Image image = read_image(folder / "a.png");
  REQUIRE(image.channels == 2);
  CHECK(image.alpha_channel == 1);
  CHECK(image.pixels == std::vector<float>{16 / 255.0F, 0, 32 / 255.0F, 1});
  for (const std::string name : {"b.png", "b.tif"}) {
    write_image(folder / name, image);
    const Image again = read_image(folder / name);
    CHECK(again.alpha_channel == 1);
    CHECK(same_bits(again.pixels, image.pixels));
  }
}

TEST_CASE("a CMYK TIFF is read as RGB", "[odd_pixels]") {
  const ImageFolder folder;
  OIIO::ImageSpec spec(16, 16, 4, OIIO::TypeDesc::UINT8);
  spec.channelnames = {"C", "M", "Y", "K"};
  spec.attribute("tiff:ColorSpace", "CMYK");
  write_by_library(folder / "a.tif", {spec});
  const Image image = read_image(folder / "a.tif");
  CHECK(image.channels == 3);
  CHECK(image.alpha_channel == -1);
  write_image(folder / "b.tif", image);
  CHECK(same_bits(read_image(folder / "b.tif").pixels, image.pixels));
}
