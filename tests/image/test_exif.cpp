// Orientation tags: texels are taken as they are stored, and the tag goes on.
#include <catch2/catch.hpp>
#include <cmath>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// A file with the tag, which the library writes into some formats only.
void write_turned(const ImageFolder& folder, const std::string& name, int orientation) {
  OIIO::ImageSpec spec(12, 7, 3, name == "a.exr" ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", orientation);
  if (name == "a.png" || name == "a.webp") {
    write_by_library(folder / "turned.tif", {spec});
    write_image(folder / name, read_image(folder / "turned.tif"));
  } else {
    write_by_library(folder / name, {spec});
  }
}

/// The orientation that warnings tell of; 1 if they tell of none.
int orientation_told(const std::vector<std::string>& warnings) {
  const std::string before = "the orientation tag ";
  for (const std::string& warning : warnings) {
    const std::size_t at = warning.find(before);
    if (at != std::string::npos) return std::stoi(warning.substr(at + before.size()));
  }
  return 1;
}

}  // namespace

TEST_CASE("an orientation tag goes on into every format that has one, and turns nothing",
          "[exif]") {
  const ImageFolder folder;
  for (const std::string from : {"a.jpg", "a.tif", "a.exr", "a.png", "a.webp"}) {
    for (const int orientation : {1, 2, 6, 8}) {
      write_turned(folder, from, orientation);
      std::vector<std::string> read;
      const Image image = read_image(folder / from, &read);
      INFO(from << " with orientation " << orientation);
      REQUIRE(orientation_told(read) == orientation);
      CHECK(read.size() == (orientation == 1 ? 0 : 1));
      REQUIRE(image.width == 12);
      for (const std::string to : {"b.jpg", "b.tif", "b.exr", "b.png", "b.webp"}) {
        INFO("to " << to);
        std::vector<std::string> written, again;
        write_image(folder / to, image, {}, &written);
        CHECK(orientation_told(written) == 1);
        const Image result = read_image(folder / to, &again);
        CHECK(orientation_told(again) == orientation);
        if (to == "b.jpg") continue;
        REQUIRE(result.pixels.size() == image.pixels.size());
        for (std::size_t i = 0; i < image.pixels.size();
             ++i)  // EXR has halves, the others integers
          REQUIRE(std::abs(result.pixels[i] - image.pixels[i]) <= 0.5F / 255);
      }
    }
  }
}

TEST_CASE("an orientation tag that the format has none of is lost with a warning", "[exif]") {
  const ImageFolder folder;
  write_turned(folder, "a.tif", 6);
  const Image image = read_image(folder / "a.tif");
  for (const std::string to : {"b.tga", "b.bmp", "b.ppm", "b.sgi", "b.hdr"}) {
    INFO(to);
    std::vector<std::string> written, again;
    write_image(folder / to, image, {}, &written);
    CHECK(orientation_told(written) == 6);
    const Image result = read_image(folder / to, &again);
    CHECK(orientation_told(again) == 1);
    if (to != "b.hdr") CHECK(same_bits(result.pixels, image.pixels));
  }
}

TEST_CASE("other programs find the orientation in a PNG", "[exif]") {
  const ImageFolder folder;
  write_turned(folder, "a.png", 6);
  const std::string bytes = slurp(folder / "a.png");
  const std::size_t at = bytes.find("eXIf");
  REQUIRE(at == 8 + 25 + 4);  // after the header and before the pixels, as the format has it
  CHECK(bytes.substr(at - 4, 4) == std::string("\0\0\0\x1a", 4));
  CHECK(png_chunk("eXIf", bytes.substr(at + 4, 26)) == bytes.substr(at - 4, 26 + 12));
}

TEST_CASE("a PNG keeps its own Exif block, whatever is in it", "[exif]") {
  const ImageFolder folder;
  const std::string row(3 * 4, '\x40');
  const std::string big =
      std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0", 22) +
      std::string(4, '\0') + "maker's note";
  dump(folder / "a.png", make_png(4, 1, 8, 2, {row}, png_chunk("eXIf", big)));
  std::vector<std::string> warnings;
  const Image image = read_image(folder / "a.png", &warnings);
  CHECK(orientation_told(warnings) == 6);
  write_image(folder / "b.png", image);
  CHECK(slurp(folder / "b.png").find(png_chunk("eXIf", big)) != std::string::npos);
  // Blocks that are none, or end early.
  for (const std::string& block :
       {std::string("II*\0\xff\xff\xff\xff\0\0", 10), std::string("nonsense"), big.substr(0, 15),
        std::string("II*\0\x08\0\0\0\xff\xff", 10), std::string()}) {
    dump(folder / "c.png", make_png(4, 1, 8, 2, {row}, png_chunk("eXIf", block)));
    std::vector<std::string> none;
    CHECK(same_bits(read_image(folder / "c.png", &none).pixels, image.pixels));
    CHECK(none.empty());
  }
}

TEST_CASE("an HDR whose rows run otherwise is refused", "[exif]") {
  const ImageFolder folder;
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  const std::string pixels(2 * 3 * 4, '\x40');
  dump(folder / "a.hdr", head + "-Y 2 +X 3\n" + pixels);
  CHECK(read_image(folder / "a.hdr").width == 3);
  dump(folder / "b.hdr", head + "+Y 2 +X 3\n" + pixels);
  CHECK_THROWS_WITH(read_image(folder / "b.hdr"), Contains("its rows do not run"));
}
