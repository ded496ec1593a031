#include <catch2/catch.hpp>
#include <filesystem>
#include <random>
#include <tuple>

#include "onmesh/base/error.h"
#include "onmesh/image/image_io.h"
#include "support/image_files.h"

namespace fs = std::filesystem;

using namespace onmesh;

TEST_CASE("an 8-bit PNG reads as its values over 255 and writes back the same", "[read_image]") {
  const ImageFolder folder;
  std::string row;
  for (int i = 0; i < 256 * 3; ++i) row += char(i * 7 % 256);
  dump(folder / "a.png", make_png(256, 2, 8, 2, {row, row}));
  const Image image = read_image(folder / "a.png");
  REQUIRE(image.width == 256);
  REQUIRE(image.height == 2);
  REQUIRE(image.channels == 3);
  CHECK(image.alpha_channel == -1);
  for (std::size_t i = 0; i < 2 * row.size(); ++i)
    REQUIRE(image.pixels[i] == float(std::uint8_t(row[i % row.size()])) / 255.0F);
  write_image(folder / "b.png", image);
  CHECK(slurp(folder / "b.png")[24] == 8);
  CHECK(same_bits(image.pixels, read_image(folder / "b.png").pixels));
}

TEST_CASE("a 16-bit PNG with alpha keeps every value, unassociated, and its text", "[read_image]") {
  const ImageFolder folder;
  std::vector<std::string> rows(3);
  std::mt19937 random(3);
  for (auto& row : rows)
    for (int i = 0; i < 500 * 8; ++i) row += char(random());
  // Alpha 0 over coloured pixels: premultiplying would lose the colour.
  for (int i = 0; i < 100; ++i)
    rows[0][std::size_t(8 * i + 6)] = rows[0][std::size_t(8 * i + 7)] = 0;
  const auto text = png_chunk("tEXt", std::string("Description\0A wall in the sun", 29));
  dump(folder / "a.png", make_png(500, 3, 16, 6, rows, text));
  const Image image = read_image(folder / "a.png");
  REQUIRE(image.channels == 4);
  CHECK(image.alpha_channel == 3);
  CHECK(image.range_channels() == std::vector<int>{0, 1, 2});
  for (std::size_t i = 0; i < 3 * 2000; ++i) {
    const std::string& row = rows[i / 2000];
    const int value = std::uint8_t(row[i % 2000 * 2]) * 256 + std::uint8_t(row[i % 2000 * 2 + 1]);
    REQUIRE(image.pixels[i] == float(value) / 65535.0F);
  }
  std::vector<std::string> warnings;
  write_image(folder / "b.png", image, {}, &warnings);
  CHECK(warnings.empty());
  const std::string written = slurp(folder / "b.png");
  CHECK(written[24] == 16);
  CHECK(written.find("A wall in the sun") != std::string::npos);
  CHECK(same_bits(image.pixels, read_image(folder / "b.png").pixels));
}

TEST_CASE("files cut short are refused at every length", "[read_image]") {
  const ImageFolder folder;
  const Image image = noise(40, 300, 3);
  for (const std::string name : {"a.png", "a.jpg", "a.tif", "a.exr", "a.bmp", "a.tga"}) {
    write_image(folder / name, image);
    const std::string bytes = slurp(folder / name);
    for (const double share : {0.001, 0.01, 0.3, 0.6, 0.9, 0.98}) {
      const fs::path cut = folder / ("cut-" + name);
      dump(cut, bytes.substr(0, std::size_t(double(bytes.size()) * share)));
      INFO(name << " cut to " << share);
      CHECK_THROWS_AS(read_image(cut), InputError);
    }
    dump(folder / name, "");
    CHECK_THROWS_AS(read_image(folder / name), InputError);
  }
}

TEST_CASE("what is no image is refused by name", "[read_image]") {
  const ImageFolder folder;
  dump(folder / "text.png", "This is no image.\n");
  CHECK_THROWS_AS(read_image(folder / "text.png"), InputError);
  CHECK_THROWS_WITH(read_image(folder / "text.png"),
                    Catch::Contains("text.png") && !Catch::Contains("\n"));
  dump(folder / "text.dat", "nor this");
  CHECK_THROWS_AS(read_image(folder / "text.dat"), InputError);
  CHECK_THROWS_AS(read_image(folder.path()), FileError);
  CHECK_THROWS_AS(read_image(folder / "missing.png"), FileError);
  CHECK_THROWS_WITH(read_image(folder / "missing.png"), Catch::Contains("No such file"));
}

TEST_CASE("huge dimensions are refused before memory is taken", "[read_image]") {
  const ImageFolder folder;
  dump(folder / "huge.png", make_png(100000, 100000, 8, 2, {"abc"}));
  CHECK_THROWS_WITH(read_image(folder / "huge.png"), Catch::Contains("100000 x 100000"));
  dump(folder / "large.png", make_png(32768, 32768, 8, 2, {"abc"}));
  CHECK_THROWS_AS(read_image(folder / "large.png"), InputError);
  dump(folder / "huge.tif", make_tiff(2000000, 2, 3, 8, 1, "abcdef"));
  CHECK_THROWS_AS(read_image(folder / "huge.tif"), InputError);
  dump(folder / "empty.png", make_png(0, 5, 8, 2, {}));
  CHECK_THROWS_AS(read_image(folder / "empty.png"), InputError);
}

TEST_CASE("a JPEG with a PNG's name is read for what it is", "[read_image]") {
  const ImageFolder folder;
  write_image(folder / "a.jpg", noise(8, 8, 3));
  fs::rename(folder / "a.jpg", folder / "a.png");
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 8);
  write_image(folder / "b.png", image);
  CHECK(same_bits(read_image(folder / "b.png").pixels, image.pixels));
}

TEST_CASE("a TGA is known by its name or by its end", "[read_image]") {
  const ImageFolder folder;
  write_image(folder / "a.tga", noise(8, 8, 3));
  fs::rename(folder / "a.tga", folder / "a.png");
  CHECK(read_image(folder / "a.png").width == 8);
  const std::string bytes = slurp(folder / "a.png");
  dump(folder / "old.tga", bytes.substr(0, 18 + 8 * 8 * 3));
  CHECK(read_image(folder / "old.tga").width == 8);
}

TEST_CASE("an SGI header that the file cannot fill is refused", "[read_image]") {
  const ImageFolder folder;
  write_image(folder / "a.sgi", noise(8, 8, 3));
  const std::string bytes = slurp(folder / "a.sgi");
  const auto with = [&](std::size_t at, char value) {
    std::string changed = bytes;
    changed.at(at) = value;
    dump(folder / "b.sgi", changed);
    return folder / "b.sgi";
  };
  CHECK(read_image(with(3, bytes[3])).width == 8);
  constexpr std::size_t kStorage = 2, kBytes = 3, kDimensions = 5, kHeight = 8, kChannels = 10;
  for (const auto& [at, value] : {std::pair{kStorage, 7},
                                  {kBytes, 0},
                                  {kBytes, 5},
                                  {kDimensions, 9},
                                  {kHeight, 100},
                                  {kChannels, 100}}) {
    INFO("byte " << at << " is " << value);
    CHECK_THROWS_AS(read_image(with(at, char(value))), InputError);
  }
}

TEST_CASE("an EXR attribute that claims more than the file holds is refused before it is read",
          "[read_image]") {
  const ImageFolder folder;
  const std::string bytes = make_exr(2, 1, {{"Y", 2}}, {little(0.5F) + little(1.0F)});
  dump(folder / "a.exr", bytes);
  CHECK(read_image(folder / "a.exr").width == 2);
  std::string changed = bytes;
  const std::string before = std::string("comments") + '\0' + "string" + '\0';
  changed.replace(changed.find(before) + before.size(), 4, little(std::int32_t(1'700'000'000)));
  dump(folder / "b.exr", changed);
  CHECK_THROWS_WITH(read_image(folder / "b.exr"), Catch::Contains("the file is truncated"));
}

TEST_CASE("an EXR attribute that is not as long as its type is refused", "[read_image]") {
  const ImageFolder folder;
  const std::string bytes = make_exr(2, 1, {{"Y", 2}}, {little(0.5F) + little(1.0F)});
  // One byte more than the type has, also where the list of channels ends by itself.
  for (const auto& [name, type, size] : {std::tuple{"channels", "chlist", 19},
                                         {"dataWindow", "box2i", 16},
                                         {"compression", "compression", 1}}) {
    INFO(name);
    const std::string head = std::string(name) + '\0' + type + '\0';
    const std::size_t at = bytes.find(head) + head.size();
    REQUIRE(bytes.substr(at, 4) == little(std::int32_t(size)));
    std::string changed = bytes;
    changed.replace(at, 4, little(std::int32_t(size + 1)));
    changed.insert(at + 4 + std::size_t(size), 1, 'x');
    dump(folder / "b.exr", changed);
    CHECK_THROWS_WITH(read_image(folder / "b.exr"), Catch::Contains("the EXR header is damaged"));
  }
}

TEST_CASE("a TGA that is shorter than its header has it is refused before there is room for it",
          "[read_image]") {
  const ImageFolder folder;
  write_image(folder / "a.tga", noise(8, 8, 3));
  const std::string bytes = slurp(folder / "a.tga").substr(0, 18 + 8 * 8 * 3);
  dump(folder / "b.tga", bytes);
  CHECK(read_image(folder / "b.tga").width == 8);
  constexpr std::size_t kType = 2, kRows = 14, kRuns = 10;
  std::string longer = bytes;
  longer.at(kRows) = 9;
  dump(folder / "b.tga", longer);
  CHECK_THROWS_WITH(read_image(folder / "b.tga"), Catch::Contains("the file is truncated"));
  // 64 x 64 texels take 32 runs of 4 bytes at least; a black square of 8 x 8 takes one.
  std::string runs = bytes.substr(0, 18);
  runs.at(kType) = char(kRuns);
  dump(folder / "b.tga", runs + std::string("\xbf\0\0\0", 4));
  CHECK(read_image(folder / "b.tga").pixels[0] == 0);
  runs.at(12) = runs.at(kRows) = 64;
  dump(folder / "b.tga", runs + std::string("\xbf\0\0\0", 4));
  CHECK_THROWS_WITH(read_image(folder / "b.tga"), Catch::Contains("the file is truncated"));
}
