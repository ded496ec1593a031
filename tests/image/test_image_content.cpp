// Images that are inside of other files: bytes in, bytes out.
#include <catch2/catch.hpp>
#include <functional>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"
#include "support/image_kinds.h"

using namespace onmesh;
using Catch::Contains;

namespace {

/// What reading gives: values, or the error.
std::string outcome(const std::function<Image()>& read) {
  try {
    const Image image = read();
    std::string text = std::to_string(image.width) + ' ' + std::to_string(image.height) + ' ';
    for (const std::string& name : image.channel_names) text += name + ' ';
    return text + std::string(reinterpret_cast<const char*>(image.pixels.data()),
                              image.pixels.size() * sizeof(float));
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("bytes are read as the file that holds them, whole or cut short", "[image_content]") {
  const ImageFolder folder;
  for (const std::string& name : write_image_kinds(folder.path())) {
    const std::string bytes = slurp(folder / name);
    for (const std::size_t length : {bytes.size(), bytes.size() / 2, std::size_t(30)}) {
      const std::string content = bytes.substr(0, length);
      dump(folder / name, content);
      std::vector<std::string> file_warnings, content_warnings;
      INFO(name << ", " << length << " bytes");
      const std::string file = outcome([&] { return read_image(folder / name, &file_warnings); });
      const std::string memory =
          outcome([&] { return read_image_content(content, folder / name, &content_warnings); });
      CHECK(file == memory);
      CHECK(file_warnings == content_warnings);
      CHECK(memory.find("/proc/") == std::string::npos);
    }
  }
}

TEST_CASE("an image is encoded to the bytes of the file that would be written", "[image_content]") {
  const ImageFolder folder;
  const Image image = noise(20, 300, 3);
  for (const std::string name : {"a.png", "a.jpg", "a.tif", "a.webp", "a.tga", "a.bmp", "a.ppm",
                                 "a.sgi", "a.hdr", "a.exr"}) {
    INFO(name);
    std::vector<std::string> warnings, expected;
    const std::string bytes = encode_image(name, image, {.bits = 8}, &warnings);
    write_image(folder / name, image, {.bits = 8}, &expected);
    CHECK(same_bits(read_image_content(bytes, name).pixels, read_image(folder / name).pixels));
    CHECK(warnings.size() == expected.size());
    // TIFF and EXR hold the time.
    if (name != "a.tif" && name != "a.exr") CHECK((bytes == slurp(folder / name)));
  }
  CHECK_THROWS_AS(encode_image("a.xyz", image), FileError);
  CHECK_THROWS_WITH(encode_image("inside.jpg", make_image(4, 4, 5)),
                    Contains("inside.jpg: jpeg cannot hold 5 channels"));
}

TEST_CASE("what bytes lose is told by the image's name", "[image_content]") {
  Image image = make_image(2, 2, 3);
  image.pixels[0] = 2;
  std::vector<std::string> warnings;
  encode_image("inside.png", image, {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("inside.png: 1 values outside"));
}
