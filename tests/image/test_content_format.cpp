// What a file is, by its content.
#include <catch2/catch.hpp>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"

using namespace onmesh;
using Catch::Contains;

TEST_CASE("the format of a file and of its bytes is told whatever the name", "[content_format]") {
  const ImageFolder folder;
  for (const auto& [name, format] : {std::pair<std::string, std::string>{"a.png", "png"},
                                     {"a.jpg", "jpeg"},
                                     {"a.tif", "tiff"},
                                     {"a.exr", "openexr"},
                                     {"a.webp", "webp"},
                                     {"a.tga", "targa"},
                                     {"a.bmp", "bmp"},
                                     {"a.ppm", "pnm"},
                                     {"a.sgi", "sgi"},
                                     {"a.hdr", "hdr"}}) {
    INFO(name);
    write_image(folder / name, noise(8, 8, 3));
    CHECK(image_file_format(folder / name) == format);
    CHECK(image_content_format(slurp(folder / name)) == format);
    CHECK(image_content_format(slurp(folder / name), "image.png") == format);
  }
  CHECK(image_content_format("no image").empty());
  CHECK(image_content_format("").empty());
  CHECK(image_file_format(folder / "missing.png").empty());
  CHECK(image_file_format(folder.path()).empty());
  const std::string old_tga = slurp(folder / "a.tga").substr(0, 18 + 8 * 8 * 3);
  CHECK(image_content_format(old_tga).empty());
  CHECK(image_content_format(old_tga, "old.tga") == "targa");
}

TEST_CASE("formats that are not read are refused by their names", "[content_format]") {
  using namespace std::string_literals;
  const ImageFolder folder;
  for (const auto& [bytes, format] : {std::pair{"\xabKTX 20\xbb\r\n\x1a\n"s, "a KTX2 texture"},
                                      {"\xabKTX 11\xbb\r\n\x1a\n"s, "a KTX texture"},
                                      {"DDS |"s, "a DDS texture"},
                                      {"8BPS\0\1"s, "a PSD image"},
                                      {"GIF89a"s, "a GIF image"},
                                      {"%PDF-1.7"s, "a PDF document"},
                                      {"\0\0\0\x0cjP  \r\n\x87\n"s, "a JPEG 2000 image"},
                                      {"\xff\x4f\xff\x51"s, "a JPEG 2000 image"},
                                      {"\0\0\0\x0cJXL \r\n\x87\n"s, "a JPEG XL image"},
                                      {"\0\0\0\x1c"s + "ftypavif"s, "an AVIF image"},
                                      {"\0\0\0\x18"s + "ftypheic"s, "a HEIC image"},
                                      {"<?xml version='1.0'?>\n<svg>"s, "an SVG drawing"},
                                      {"\xef\xbb\xbf \n<svg/>"s, "an SVG drawing"}}) {
    const std::string expected = "is "s + format + ", which is not read; convert it";
    const std::string content = bytes + std::string(40, '\0');
    for (const std::string name : {"a.png", "a.tga", "a"}) {
      INFO(name << " with " << format);
      dump(folder / name, content);
      CHECK_THROWS_WITH(read_image(folder / name), Contains(name + ": " + expected));
    }
    CHECK_THROWS_WITH(read_image_content(content, "inside.glb"),
                      Contains("inside.glb: " + expected));
    CHECK(image_content_format(content).empty());
  }
}
