// EXR with a data window that is not its display window.
#include <catch2/catch.hpp>
#include <tuple>

#include "onmesh/base/error.h"
#include "onmesh/image/data_window.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/library_images.h"

using namespace onmesh;
using Catch::Contains;

namespace {

OIIO::ImageSpec windowed(const PixelWindow& data, const PixelWindow& display, int tile = 0) {
  OIIO::ImageSpec spec(data.width, data.height, 3, OIIO::TypeDesc::HALF);
  spec.x = data.x;
  spec.y = data.y;
  spec.full_x = display.x;
  spec.full_y = display.y;
  spec.full_width = display.width;
  spec.full_height = display.height;
  spec.tile_width = spec.tile_height = tile;
  spec.tile_depth = tile > 0 ? 1 : 0;
  return spec;
}

PixelWindow full_window(const OIIO::ImageSpec& spec) {
  return {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
}

bool contains(const PixelWindow& window, int x, int y) {
  return !overlap_of(window, {x, y, 1, 1}).is_empty();
}

}  // namespace

TEST_CASE("windows overlap and span", "[data_window]") {
  const PixelWindow a{-3, 2, 10, 5}, b{4, -1, 6, 4};
  CHECK(overlap_of(a, b) == PixelWindow{4, 2, 3, 1});
  CHECK(around_both(a, b) == PixelWindow{-3, -1, 13, 8});
  CHECK(overlap_of(a, {7, 2, 5, 5}).is_empty());
  CHECK(overlap_of(a, a) == a);
  CHECK(shared_row(a, b, 0).from == 7);
  CHECK(shared_row(a, b, 0).to == 3 * 6);
  CHECK(shared_row(a, b, 0).count == 3);
  CHECK(shared_row(a, b, 1).count == 0);
}

TEST_CASE("the texture is the display window, zero where there are no pixels", "[data_window]") {
  const ImageFolder folder;
  // Overscan, a crop, both at once, origins below zero, tiles that begin at none.
  for (const auto& [data, display, tile] :
       {std::tuple{PixelWindow{-4, -3, 40, 30}, PixelWindow{0, 0, 32, 24}, 0},
        {PixelWindow{5, 300, 20, 270}, PixelWindow{0, 0, 32, 600}, 0},
        {PixelWindow{-7, 5, 20, 30}, PixelWindow{-2, -9, 40, 20}, 0},
        {PixelWindow{-7, 5, 37, 45}, PixelWindow{-2, -9, 40, 20}, 16}}) {
    INFO(window_text(data) << " in " << window_text(display));
    write_by_library(folder / "a.exr", {windowed(data, display, tile)});
    const std::vector<float> pixels = pixels_by_library(folder / "a.exr");
    std::vector<std::string> warnings;
    const Image image = read_image(folder / "a.exr", &warnings);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0],
               Contains("a.exr") && Contains(window_text(display)) && Contains(window_text(data)));
    REQUIRE(image.width == display.width);
    REQUIRE(image.height == display.height);
    for (int y = 0; y < display.height; ++y) {
      for (int x = 0; x < display.width; ++x) {
        const int column = display.x + x - data.x, row = display.y + y - data.y;
        const float expected = contains(data, display.x + x, display.y + y)
                                   ? pixels[std::size_t(row * data.width + column) * 3]
                                   : 0.0F;
        REQUIRE(image.texel(Index(y * display.width + x))[0] == expected);
      }
    }
    warnings.clear();
    write_image(folder / "b.exr", image, {}, &warnings);
    CHECK(warnings.empty());
    const OIIO::ImageSpec spec = spec_by_library(folder / "b.exr");
    CHECK(data_window(spec) == data);
    CHECK(full_window(spec) == display);
    CHECK(spec.tile_width == tile);
    CHECK(same_bits(pixels_by_library(folder / "b.exr"), pixels));
  }
}

TEST_CASE("a changed texel changes its pixel only", "[data_window]") {
  const ImageFolder folder;
  const PixelWindow data{-4, -3, 40, 30}, display{0, 0, 32, 24};
  write_by_library(folder / "a.exr", {windowed(data, display)});
  Image image = read_image(folder / "a.exr");
  image.texel(5 * 32 + 7)[1] = 2;
  write_image(folder / "a.exr", image);
  std::vector<float> expected = pixels_by_library(folder / "a.exr");
  write_by_library(folder / "b.exr", {windowed(data, display)});
  std::vector<float> before = pixels_by_library(folder / "b.exr");
  before[((5 + 3) * 40 + 7 + 4) * 3 + 1] = 2;
  CHECK(same_bits(before, expected));
  // As floats, too, overscan has the values that it had.
  write_image(folder / "c.exr", image, {.force_float = true});
  CHECK(spec_by_library(folder / "c.exr").format == OIIO::TypeDesc::FLOAT);
  CHECK(same_bits(pixels_by_library(folder / "c.exr"), before));
}

TEST_CASE("the data window grows around texels that have got values outside of it",
          "[data_window]") {
  const ImageFolder folder;
  const PixelWindow data{-4, 6, 20, 10}, display{0, 0, 32, 24};
  write_by_library(folder / "a.exr", {windowed(data, display)});
  const std::vector<float> overscan = pixels_by_library(folder / "a.exr");
  Image image = read_image(folder / "a.exr");
  image.texel(31)[2] = 0.5F;
  std::vector<std::string> warnings;
  write_image(folder / "b.exr", image, {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("20 x 10 at (-4, 6)") && Contains("36 x 24 at (-4, 0)"));
  const OIIO::ImageSpec spec = spec_by_library(folder / "b.exr");
  CHECK(data_window(spec) == PixelWindow{-4, 0, 36, 24});
  CHECK(full_window(spec) == display);
  CHECK(same_bits(read_image(folder / "b.exr").pixels, image.pixels));
  const std::vector<float> pixels = pixels_by_library(folder / "b.exr");
  for (std::size_t y = 0; y < 10; ++y) {
    for (std::size_t x = 0; x < 4 * 3; ++x)
      REQUIRE(pixels[(y + 6) * 36 * 3 + x] == overscan[y * 20 * 3 + x]);
  }
}

TEST_CASE("formats without windows hold the display window, with a warning", "[data_window]") {
  const ImageFolder folder;
  write_by_library(folder / "a.exr", {windowed({-4, 6, 20, 10}, {-1, 0, 32, 24})});
  const Image image = read_image(folder / "a.exr");
  std::vector<std::string> warnings;
  write_image(folder / "b.tif", image, {}, &warnings);
  REQUIRE(warnings.size() >= 1);
  CHECK_THAT(warnings.back(), Contains("20 x 10 at (-4, 6)") && Contains("format has none"));
  CHECK(same_bits(read_image(folder / "b.tif").pixels, image.pixels));
  // Unsigned integers of 32 bits have to be kept apart from the values.
  OIIO::ImageSpec spec = windowed({-4, 6, 20, 10}, {-1, 0, 32, 24});
  spec.set_format(OIIO::TypeDesc::UINT32);
  write_by_library(folder / "c.exr", {spec});
  write_image(folder / "d.tif", read_image(folder / "c.exr"));
  write_image(folder / "e.exr", read_image(folder / "c.exr"));
  CHECK(same_bits(read_image(folder / "d.tif").pixels, read_image(folder / "c.exr").pixels));
  CHECK(same_bits(pixels_by_library(folder / "e.exr"), pixels_by_library(folder / "c.exr")));
}

TEST_CASE("windows that share no pixel, or are too large, are refused", "[data_window]") {
  const ImageFolder folder;
  write_by_library(folder / "a.exr", {windowed({40, 0, 8, 8}, {0, 0, 32, 24})});
  CHECK_THROWS_WITH(read_image(folder / "a.exr"), Contains("no pixels inside its display window"));
  write_by_library(folder / "b.exr", {windowed({0, 0, 8, 8}, {0, 0, 100000, 100000})});
  CHECK_THROWS_WITH(read_image(folder / "b.exr"), Contains("100000 x 100000"));
  // Its data window alone claims to be huge.
  write_by_library(folder / "c.exr", {windowed({0, 0, 8, 8}, {0, 0, 4, 4})});
  std::string bytes = slurp(folder / "c.exr");
  const std::string head = std::string("dataWindow\0box2i\0", 17) + little(std::int32_t(16));
  bytes.replace(bytes.find(head) + head.size() + 8, 8,
                little(std::int32_t(99999)) + little(std::int32_t(99999)));
  dump(folder / "c.exr", bytes);
  CHECK_THROWS_AS(read_image(folder / "c.exr"), InputError);
}

TEST_CASE("the place of a TIFF on a page is kept, and shifts nothing", "[data_window]") {
  const ImageFolder folder;
  OIIO::ImageSpec spec = windowed({3, 4, 16, 8}, {0, 0, 32, 32});
  spec.set_format(OIIO::TypeDesc::UINT8);
  write_by_library(folder / "a.tif", {spec});
  std::vector<std::string> warnings;
  const Image image = read_image(folder / "a.tif", &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("place on a page"));
  CHECK(image.width == 16);
  CHECK(image.height == 8);
  write_image(folder / "b.tif", image);
  const OIIO::ImageSpec again = spec_by_library(folder / "b.tif");
  CHECK(data_window(again) == PixelWindow{3, 4, 16, 8});
  CHECK(full_window(again) == PixelWindow{0, 0, 32, 32});
  CHECK(same_bits(read_image(folder / "b.tif").pixels, image.pixels));
}
