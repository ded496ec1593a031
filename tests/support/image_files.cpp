#include "support/image_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

namespace onmesh {
namespace {

std::string big_endian(std::uint32_t v) {
  return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
}

std::string exr_attribute(const std::string& name, const std::string& type,
                          const std::string& value) {
  return name + '\0' + type + '\0' + little(std::int32_t(value.size())) + value;
}

}  // namespace

std::size_t ImageFolder::files() const {
  using Files = std::filesystem::directory_iterator;
  return std::size_t(std::distance(Files(path()), Files()));
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void dump(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xffffffffU;
  for (const char ch : type + data) {
    crc ^= std::uint8_t(ch);
    for (int i = 0; i < 8; ++i) crc = crc & 1U ? 0xedb88320U ^ crc >> 1 : crc >> 1;
  }
  return big_endian(std::uint32_t(data.size())) + type + data + big_endian(~crc);
}

std::string make_png(std::uint32_t width, std::uint32_t height, int bits, int colour_type,
                     const std::vector<std::string>& rows, const std::string& extra) {
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

std::string make_tiff(int width, int height, int channels, int bits, int sample_format,
                      const std::string& data, const std::string& description, int tile) {
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

Image noise(int width, int height, int channels, unsigned seed) {
  Image image = make_image(width, height, channels);
  std::mt19937 random(seed);
  for (float& v : image.pixels) v = float(random() & 0xffffU) / 65535.0F;
  return image;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace onmesh
