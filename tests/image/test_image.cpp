#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>

#include "onmesh/base/error.h"
#include "onmesh/image/image.h"

namespace fs = std::filesystem;
using namespace onmesh;

namespace {

/// A folder of its own, removed at the end.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "onmesh-image-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path operator/(const std::string& name) const { return path / name; }
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void dump(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string big_endian(std::uint32_t v) {
  return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
}

template <class T>
std::string little(T v) {
  std::string s(sizeof(T), '\0');
  std::memcpy(s.data(), &v, sizeof(T));
  return s;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xffffffffU;
  for (const char ch : type + data) {
    crc ^= std::uint8_t(ch);
    for (int i = 0; i < 8; ++i) crc = crc & 1U ? 0xedb88320U ^ crc >> 1 : crc >> 1;
  }
  return big_endian(std::uint32_t(data.size())) + type + data + big_endian(~crc);
}

/// A PNG of stored blocks; `rows` holds the bytes of each row.
std::string make_png(std::uint32_t width, std::uint32_t height, int bits, int colour_type,
                     const std::vector<std::string>& rows, const std::string& extra = {}) {
  std::string raw;
  for (const auto& row : rows) raw += std::string(1, '\0') + row;
  std::uint32_t a = 1, b = 0;
  for (const char ch : raw) {
    a = (a + std::uint8_t(ch)) % 65521;
    b = (b + a) % 65521;
  }
  std::string zlib = "\x78\x01";
  for (std::size_t at = 0; at < raw.size(); at += 65535) {
    const auto n = std::uint16_t(std::min<std::size_t>(65535, raw.size() - at));
    zlib += std::string(1, at + n == raw.size() ? '\1' : '\0') + little(n) +
            little(std::uint16_t(~n)) + raw.substr(at, n);
  }
  zlib += big_endian(b << 16 | a);
  const std::string header = big_endian(width) + big_endian(height) + char(bits) +
                             char(colour_type) + std::string(3, '\0');
  return std::string("\x89PNG\r\n\x1a\n") + png_chunk("IHDR", header) + extra +
         png_chunk("IDAT", zlib) + png_chunk("IEND", "");
}

std::string exr_attribute(const std::string& name, const std::string& type,
                          const std::string& value) {
  return name + '\0' + type + '\0' + little(std::int32_t(value.size())) + value;
}

/// An uncompressed scanline EXR; channel types 0 = uint, 1 = half, 2 = float, names ascending;
/// `data` holds, row by row, each channel's row.
std::string make_exr(int width, int height,
                     const std::vector<std::pair<std::string, int>>& channels,
                     const std::vector<std::string>& data) {
  std::string list;
  for (const auto& [name, type] : channels)
    list += name + '\0' + little(type) + std::string(4, '\0') + little(1) + little(1);
  list += '\0';
  const std::string window = little(0) + little(0) + little(width - 1) + little(height - 1);
  std::string file = little(20000630) + little(2) + exr_attribute("channels", "chlist", list) +
                     exr_attribute("comments", "string", "kept by the filter") +
                     exr_attribute("compression", "compression", std::string(1, '\0')) +
                     exr_attribute("dataWindow", "box2i", window) +
                     exr_attribute("displayWindow", "box2i", window) +
                     exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                     exr_attribute("pixelAspectRatio", "float", little(1.0F)) +
                     exr_attribute("screenWindowCenter", "v2f", little(0.0F) + little(0.0F)) +
                     exr_attribute("screenWindowWidth", "float", little(1.0F)) + '\0';
  std::uint64_t at = file.size() + 8 * data.size();
  for (const auto& row : data) {
    file += little(at);
    at += 8 + row.size();
  }
  for (std::size_t y = 0; y < data.size(); ++y)
    file += little(std::int32_t(y)) + little(std::int32_t(data[y].size())) + data[y];
  return file;
}

/// An uncompressed TIFF of one strip; sample format 1 = unsigned, 2 = signed, 3 = float.
std::string make_tiff(int width, int height, int channels, int bits, int sample_format,
                      const std::string& data, const std::string& description = "kept",
                      int tile = 0) {
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };
  const auto shorts = [&](int v) {
    std::string s;
    for (int c = 0; c < channels; ++c) s += little(std::uint16_t(v));
    return s;
  };
  const auto number = [](int v) { return little(std::uint32_t(v)); };
  const auto n = std::uint32_t(channels);
  std::vector<Entry> entries = {{256, 4, 1, number(width)},
                                {257, 4, 1, number(height)},
                                {258, 3, n, shorts(bits)},
                                {259, 4, 1, number(1)},
                                {262, 4, 1, number(channels >= 3 ? 2 : 1)},
                                {270, 2, std::uint32_t(description.size() + 1), description + '\0'},
                                {273, 4, 1, number(8)},
                                {277, 4, 1, number(channels)},
                                {278, 4, 1, number(height)},
                                {279, 4, 1, number(int(data.size()))},
                                {284, 4, 1, number(1)},
                                {339, 3, n, shorts(sample_format)}};
  if (tile > 0) {  // one tile instead of one strip
    std::erase_if(entries,
                  [](const Entry& e) { return e.tag == 273 || e.tag == 278 || e.tag == 279; });
    const std::vector<Entry> tiles = {{322, 4, 1, number(tile)},
                                      {323, 4, 1, number(tile)},
                                      {324, 4, 1, number(8)},
                                      {325, 4, 1, number(int(data.size()))}};
    entries.insert(entries.end() - 1, tiles.begin(), tiles.end());
  }

  std::string file = std::string("II*\0", 4) + number(8 + int(data.size())) + data;
  std::string directory = little(std::uint16_t(entries.size())), tail;
  const std::size_t after = file.size() + 2 + 12 * entries.size() + 4;
  for (auto& e : entries) {
    directory += little(e.tag) + little(e.type) + little(e.count);
    if (e.value.size() > 4) {
      directory += number(int(after + tail.size()));
      tail += e.value;
    } else {
      directory += e.value + std::string(4 - e.value.size(), '\0');
    }
  }
  return file + directory + std::string(4, '\0') + tail;
}

Image noise(int width, int height, int channels, unsigned seed = 1) {
  Image image = make_image(width, height, channels);
  std::mt19937 random(seed);
  for (float& v : image.pixels) v = float(random() & 0xffffU) / 65535.0F;
  return image;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("an 8-bit PNG reads as its values over 255 and writes back the same", "[image]") {
  const Folder folder;
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

TEST_CASE("a 16-bit PNG with alpha keeps every value, unassociated, and its text", "[image]") {
  const Folder folder;
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

TEST_CASE("a half EXR keeps every bit pattern, names and metadata", "[image]") {
  const Folder folder;
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

TEST_CASE("changed values of an EXR are rounded to the nearest half", "[image]") {
  const Folder folder;
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

TEST_CASE("integers and doubles beyond float keep their own bits", "[image]") {
  const Folder folder;
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

TEST_CASE("a float TIFF keeps values that are not finite", "[image]") {
  const Folder folder;
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

TEST_CASE("a tiled TIFF stays tiled and keeps its values", "[image]") {
  const Folder folder;
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

TEST_CASE("an image from memory comes back as float from TIFF and EXR", "[image]") {
  const Folder folder;
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

TEST_CASE("channel names given in memory reach an EXR", "[image]") {
  const Folder folder;
  Image image = noise(4, 4, 3);
  image.channel_names = {"face", "position.x", "position.y"};
  write_image(folder / "a.exr", image);
  CHECK(read_image(folder / "a.exr").channel_names == image.channel_names);
}

TEST_CASE("integer formats keep 8-bit values for every channel count they hold", "[image]") {
  const Folder folder;
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

TEST_CASE("float values in a PNG become 16 bit, clamped, with a warning", "[image]") {
  const Folder folder;
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

TEST_CASE("forced float writes an 8-bit source as 32-bit float", "[image]") {
  const Folder folder;
  write_image(folder / "a.png", noise(5, 5, 3), {.bits = 8});
  Image image = read_image(folder / "a.png");
  for (float& v : image.pixels) v += 1e-5F;
  write_image(folder / "a.tif", image, {.force_float = true});
  CHECK(same_bits(read_image(folder / "a.tif").pixels, image.pixels));
}

TEST_CASE("a JPEG is written close to its values and without alpha only", "[image]") {
  const Folder folder;
  Image image = make_image(64, 64, 3);
  for (Index i = 0; i < 64 * 64; ++i) {
    image.texel(i)[0] = float(i % 64) / 63;
    image.texel(i)[1] = float(i / 64) / 63;
    image.texel(i)[2] = i % 64 < 32 ? 0.25F : 0.75F;
  }
  write_image(folder / "a.jpg", image);
  const Image again = read_image(folder / "a.jpg");
  REQUIRE(again.channels == 3);
  double worst = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    worst = std::max(worst, std::abs(double(image.pixels[i]) - double(again.pixels[i])));
  CHECK(worst < 0.03);
  Image with_alpha = make_image(8, 8, 4);
  with_alpha.alpha_channel = 3;
  CHECK_THROWS_AS(check_writable_image(folder / "b.jpg", with_alpha), InputError);
  CHECK_THROWS_AS(write_image(folder / "b.jpg", with_alpha), InputError);
  CHECK_THROWS_AS(check_writable_image(folder / "b.png", make_image(2, 2, 5)), InputError);
  CHECK_THROWS_WITH(check_writable_image(folder / "b.jpg", with_alpha),
                    Catch::Contains("b.jpg") && Catch::Contains("alpha"));
  CHECK(folder.files() == 1);
}

TEST_CASE("files cut short are refused at every length", "[image]") {
  const Folder folder;
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

TEST_CASE("what is no image is refused by name", "[image]") {
  const Folder folder;
  dump(folder / "text.png", "This is no image.\n");
  CHECK_THROWS_AS(read_image(folder / "text.png"), InputError);
  CHECK_THROWS_WITH(read_image(folder / "text.png"),
                    Catch::Contains("text.png") && !Catch::Contains("\n"));
  dump(folder / "text.dat", "nor this");
  CHECK_THROWS_AS(read_image(folder / "text.dat"), InputError);
  CHECK_THROWS_AS(read_image(folder.path), FileError);
  CHECK_THROWS_AS(read_image(folder / "missing.png"), FileError);
  CHECK_THROWS_WITH(read_image(folder / "missing.png"), Catch::Contains("No such file"));
}

TEST_CASE("huge dimensions are refused before memory is taken", "[image]") {
  const Folder folder;
  dump(folder / "huge.png", make_png(100000, 100000, 8, 2, {"abc"}));
  CHECK_THROWS_WITH(read_image(folder / "huge.png"), Catch::Contains("100000 x 100000"));
  dump(folder / "large.png", make_png(32768, 32768, 8, 2, {"abc"}));
  CHECK_THROWS_AS(read_image(folder / "large.png"), InputError);
  dump(folder / "huge.tif", make_tiff(2000000, 2, 3, 8, 1, "abcdef"));
  CHECK_THROWS_AS(read_image(folder / "huge.tif"), InputError);
  dump(folder / "empty.png", make_png(0, 5, 8, 2, {}));
  CHECK_THROWS_AS(read_image(folder / "empty.png"), InputError);
}

TEST_CASE("a JPEG with a PNG's name is read for what it is", "[image]") {
  const Folder folder;
  write_image(folder / "a.jpg", noise(8, 8, 3));
  fs::rename(folder / "a.jpg", folder / "a.png");
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 8);
  write_image(folder / "b.png", image);
  CHECK(same_bits(read_image(folder / "b.png").pixels, image.pixels));
}

TEST_CASE("a target that cannot be written is refused and nothing is left behind", "[image]") {
  const Folder folder;
  const Image image = noise(8, 8, 3);
  for (const std::string name : {"missing/a.png", "a.xyz", "a", "folder.png"}) {
    fs::create_directory(folder / "folder.png");
    INFO(name);
    CHECK_THROWS_AS(check_writable_image(folder / name, image), FileError);
    CHECK_THROWS_AS(write_image(folder / name, image), FileError);
    CHECK(folder.files() == 1);
  }
  CHECK_THROWS_AS(write_image(folder / "a.png", Image()), InputError);
  REQUIRE(mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
  CHECK_THROWS_AS(write_image(folder / "pipe.png", image), FileError);
}

TEST_CASE("when the disk is full the target stays as it was", "[image]") {
  const Folder folder;
  const Image image = noise(200, 200, 3);
  // A limit on file size fails writes the way a full disk does.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const std::string name : {"a.png", "a.jpg", "a.tif", "a.exr", "a.tga", "a.bmp", "a.sgi"}) {
    dump(folder / name, "precious");
    rlimit limit = before;
    limit.rlim_cur = 2000;
    setrlimit(RLIMIT_FSIZE, &limit);
    INFO(name);
    std::string message;
    try {
      write_image(folder / name, image);
    } catch (const FileError& error) {
      message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(message.find(name) != std::string::npos);
    CHECK(slurp(folder / name) == "precious");
    CHECK(folder.files() == 1);
    fs::remove(folder / name);
  }
  std::signal(SIGXFSZ, handler);
}

TEST_CASE("a link stays a link and permissions stay as they were", "[image]") {
  const Folder folder;
  fs::create_directory(folder / "real");
  dump(folder / "real/a.png", "old");
  fs::permissions(folder / "real/a.png", fs::perms(0640));
  fs::create_symlink("real/a.png", folder / "a.png");
  const Image image = noise(8, 8, 3);
  write_image(folder / "a.png", image);
  CHECK(fs::is_symlink(folder / "a.png"));
  CHECK(fs::status(folder / "real/a.png").permissions() == fs::perms(0640));
  CHECK(read_image(folder / "real/a.png").width == 8);
  const mode_t mask = umask(027);
  write_image(folder / "new.png", image);
  umask(mask);
  CHECK(fs::status(folder / "new.png").permissions() == fs::perms(0640));
}

TEST_CASE("writing over the file that was read works", "[image]") {
  const Folder folder;
  write_image(folder / "a.tif", noise(50, 50, 4));
  Image image = read_image(folder / "a.tif");
  image.pixels[5] = 0.125F;
  write_image(folder / "a.tif", image);
  CHECK(same_bits(read_image(folder / "a.tif").pixels, image.pixels));
}
