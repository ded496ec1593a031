#include "onmesh/image/check_content.h"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <utility>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr int kLargestSide = 32768;
constexpr std::uint64_t kMostValues = std::uint64_t(1) << 32;  // 16 GB of float

/// Walk over a PNG's chunks: libpng prints to stderr when the file ends early, and its dimensions
/// are not checked by anyone before it allocates.
void check_png(const ImagePlace& place) {
  std::ifstream file(place.path, std::ios::binary);
  const auto size = std::filesystem::file_size(place.path);
  std::array<unsigned char, 8> head{};
  const auto number = [](const unsigned char* b) {
    return std::uint32_t(b[0]) << 24 | std::uint32_t(b[1]) << 16 | std::uint32_t(b[2]) << 8 | b[3];
  };
  for (std::uint64_t at = 8;;) {
    file.seekg(std::streamoff(at));
    file.read(reinterpret_cast<char*>(head.data()), 8);
    if (!file) refuse_image(place.name, "the file is truncated");
    const std::uint64_t next = at + 12 + number(head.data());
    if (next > size) refuse_image(place.name, "the file is truncated");
    if (std::memcmp(head.data() + 4, "IHDR", 4) == 0) {
      file.read(reinterpret_cast<char*>(head.data()), 8);
      if (file) check_image_size(place.name, number(head.data()), number(head.data() + 4), 1);
    } else if (std::memcmp(head.data() + 4, "IEND", 4) == 0) {
      return;
    }
    at = next;
  }
}

/// Bytes of an EXR's attribute, by its type: OpenEXR reads so many whatever the file says. 0 = as
/// many as that says. (Sizes: "OpenEXR File Layout", the attribute types.)
std::uint32_t fixed_size(std::string_view type) {
  static constexpr std::pair<std::string_view, std::uint32_t> kSizes[] = {
      {"box2f", 16},      {"box2i", 16},    {"chromaticities", 32},
      {"compression", 1}, {"double", 8},    {"deepImageState", 1},
      {"envmap", 1},      {"float", 4},     {"int", 4},
      {"keycode", 28},    {"lineOrder", 1}, {"m33d", 72},
      {"m33f", 36},       {"m44d", 128},    {"m44f", 64},
      {"rational", 8},    {"timecode", 8},  {"tiledesc", 9},
      {"v2d", 16},        {"v2f", 8},       {"v2i", 8},
      {"v3d", 24},        {"v3f", 12},      {"v3i", 12}};
  for (const auto& [name, size] : kSizes)
    if (name == type) return size;
  return 0;
}

/// Whether a list of channels, which has an end of its own, ends where the attribute does.
bool is_channel_list(const std::string& bytes) {
  constexpr std::size_t kChannel = 16;  // bytes after the name
  std::size_t at = 0;
  while (at < bytes.size() && bytes[at] != '\0') {
    const std::size_t end = bytes.find('\0', at);
    if (end == std::string::npos) return false;
    at = end + 1 + kChannel;
  }
  return at + 1 == bytes.size();
}

/// Whether a thumbnail has the pixels that it says.
bool is_preview(const std::string& bytes) {
  if (bytes.size() < 8) return false;
  const std::uint64_t width = from_bytes<std::uint32_t>(bytes.data(), std::endian::little);
  const std::uint64_t height = from_bytes<std::uint32_t>(bytes.data() + 4, std::endian::little);
  return (width == 0 || height <= bytes.size() / width) && 8 + 4 * width * height == bytes.size();
}

/// Walk over an EXR's attributes: OpenEXR makes room for as many bytes as each of them claims to
/// have, and fills it, before it looks whether they are there; and where one is not as long as its
/// type has it, it takes what follows for the next one.
void check_exr(const ImagePlace& place) {
  std::ifstream file(place.path, std::ios::binary);
  const auto size = std::filesystem::file_size(place.path);
  std::array<unsigned char, 8> head{};
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!file) refuse_image(place.name, "the file is truncated");
  // Headers end with an empty name. Of several parts each has one, and an empty one ends the list.
  const bool several = (head[5] & 0x10U) != 0;
  bool header_begins = true;
  for (std::string name, type; std::getline(file, name, '\0');) {
    if (name.empty()) {
      if (!several || header_begins) return;
      header_begins = true;
      continue;
    }
    header_begins = false;
    std::array<char, 4> length{};
    std::getline(file, type, '\0');
    file.read(length.data(), length.size());
    const auto bytes = from_bytes<std::uint32_t>(length.data(), std::endian::little);
    const std::uint64_t next = std::uint64_t(file.tellg()) + bytes;
    if (!file || next > size) break;
    bool sound = fixed_size(type) == 0 || fixed_size(type) == bytes;
    if (type == "chlist" || type == "preview") {
      std::string value(bytes, '\0');
      file.read(value.data(), std::streamsize(bytes));
      sound = type == "chlist" ? is_channel_list(value) : is_preview(value);
    }
    if (!sound) refuse_image(place.name, "the EXR header is damaged");
    file.seekg(std::streamoff(next));
  }
  refuse_image(place.name, "the file is truncated");
}

/// Check an SGI file's header: OpenImageIO takes it for true, whatever the bytes per channel, and
/// looks for every channel of every row in a file that may be too short for them.
void check_sgi(const ImagePlace& place) {
  constexpr std::uint64_t kHeader = 512, kTableEntry = 8;  // bytes
  std::array<unsigned char, 12> head{};
  std::ifstream file(place.path, std::ios::binary);
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!file) refuse_image(place.name, "the file is truncated");
  const auto number = [&](std::size_t at) {
    return std::uint64_t(head[at]) << 8 | std::uint64_t(head[at + 1]);
  };
  const bool compressed = head[2] == 1;
  const std::uint64_t bytes = head[3], dimensions = number(4), width = number(6);
  const std::uint64_t height = dimensions > 1 ? number(8) : 1;
  const std::uint64_t channels = dimensions > 2 ? number(10) : 1;
  if (head[2] > 1 || bytes < 1 || bytes > 2 || dimensions < 1 || dimensions > 3)
    refuse_image(place.name, "the SGI header is damaged");
  check_image_size(place.name, std::int64_t(width), std::int64_t(height), std::int64_t(channels));
  const std::uint64_t rows = height * channels;
  const std::uint64_t least = kHeader + rows * (compressed ? kTableEntry : width * bytes);
  if (std::filesystem::file_size(place.path) < least)
    refuse_image(place.name, "the file is truncated");
}

/// Whether a TGA is as long as its header has it: OpenImageIO makes room for all its texels first.
/// (Truevision TGA File Format Specification 2.0: 128 texels at most in a run.)
void check_tga(const ImagePlace& place) {
  constexpr std::uint64_t kHeader = 18, kLongestRun = 128;
  std::array<unsigned char, kHeader> head{};
  std::ifstream file(place.path, std::ios::binary);
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!file) refuse_image(place.name, "the file is truncated");
  const auto number = [&](std::size_t at) {
    return std::uint64_t(head[at]) | std::uint64_t(head[at + 1]) << 8;
  };
  const std::uint64_t width = number(12), height = number(14), bytes = (head[16] + 7U) / 8;
  check_image_size(place.name, std::int64_t(width), std::int64_t(height), 1);
  const std::uint64_t palette = head[1] == 1 ? number(5) * ((head[7] + 7U) / 8) : 0;
  const bool in_runs = head[2] >= 9;
  const std::uint64_t texels = width * height;
  const std::uint64_t runs = (texels + kLongestRun - 1) / kLongestRun;
  const std::uint64_t least = in_runs ? runs * (1 + bytes) : texels * bytes;
  if (std::filesystem::file_size(place.path) < kHeader + head[0] + palette + least)
    refuse_image(place.name, "the file is truncated");
}

/// Walk over a WebP's chunks: whether they are there, before all of the file is read.
/// (WebP Container Specification.)
void check_webp(const ImagePlace& place) {
  constexpr std::uint64_t kAfterSize = 8, kFirstChunk = 12;
  std::ifstream file(place.path, std::ios::binary);
  std::array<char, kFirstChunk> head{};
  file.read(head.data(), head.size());
  const std::uint64_t end =
      kAfterSize + from_bytes<std::uint32_t>(head.data() + 4, std::endian::little);
  if (!file || end > std::filesystem::file_size(place.path))
    refuse_image(place.name, "the file is truncated");
  for (std::uint64_t at = kFirstChunk; at < end;) {
    file.seekg(std::streamoff(at));
    file.read(head.data(), kAfterSize);
    if (!file) refuse_image(place.name, "the file is truncated");
    const std::uint64_t bytes = from_bytes<std::uint32_t>(head.data() + 4, std::endian::little);
    if (at + kAfterSize + bytes > end)
      refuse_image(place.name, "a chunk of the WebP is longer than the file says");
    at += kAfterSize + bytes + bytes % 2;  // chunks begin at even places
  }
}

}  // namespace

void refuse_image(const std::filesystem::path& name, const std::string& why) {
  throw InputError(name.string() + ": " + why);
}

void check_image_size(const std::filesystem::path& name, std::int64_t width, std::int64_t height,
                      std::int64_t channels) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || channels < 1)
    refuse_image(name, "the image is empty (" + size + ")");
  if (width > kLargestSide || height > kLargestSide)
    refuse_image(name, "the image is too large: " + size + ", at most 32768 x 32768 is read");
  if (std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) > kMostValues)
    refuse_image(name, "the image is too large: " + size + " with " + std::to_string(channels) +
                           " channels, at most 2^32 values are read");
}

void check_content(const ImagePlace& place, std::string_view format) {
  if (format == "png") check_png(place);
  if (format == "openexr") check_exr(place);
  if (format == "sgi") check_sgi(place);
  if (format == "targa") check_tga(place);
  if (format == "webp") check_webp(place);
}

}  // namespace onmesh
