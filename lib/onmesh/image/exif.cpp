#include "onmesh/image/exif.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "onmesh/base/byte_order.h"

namespace onmesh {
namespace {

using namespace std::string_view_literals;

constexpr std::uint16_t kOrientationTag = 0x112, kShort = 3;
constexpr std::size_t kTiffHeader = 8, kEntry = 12;  // bytes

/// The orientation in the first directory of a block; 1 if it has none.
int orientation_in(std::string_view tiff) {
  const std::endian order = tiff.starts_with("MM") ? std::endian::big : std::endian::little;
  if (tiff.size() < kTiffHeader + 2) return 1;
  const std::size_t directory = from_bytes<std::uint32_t>(tiff.data() + 4, order);
  if (directory > tiff.size() - 2) return 1;
  const std::size_t entries = from_bytes<std::uint16_t>(tiff.data() + directory, order);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + i * kEntry;
    if (at + kEntry > tiff.size()) return 1;
    const auto number = [&](std::size_t offset) {
      return from_bytes<std::uint16_t>(tiff.data() + at + offset, order);
    };
    if (number(0) != kOrientationTag || number(2) != kShort) continue;
    const int value = number(8);
    return value >= 1 && value <= 8 ? value : 1;
  }
  return 1;
}

/// The checksum of a PNG's chunk (PNG specification, annex D).
std::uint32_t png_checksum(std::string_view bytes) {
  std::uint32_t sum = 0xffffffffU;
  for (const char c : bytes) {
    sum ^= std::uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? 0xedb88320U ^ sum >> 1 : sum >> 1;
  }
  return ~sum;
}

}  // namespace

int orientation_of(const OIIO::ImageSpec& spec) {
  const int value = spec.get_int_attribute("Orientation", 1);
  return value >= 1 && value <= 8 ? value : 1;
}

void set_exif(OIIO::ImageSpec& spec, std::string_view block) {
  constexpr std::string_view kPrefix = "Exif\0\0"sv;
  if (block.starts_with(kPrefix)) block.remove_prefix(kPrefix.size());
  if (!block.starts_with("II*\0"sv) && !block.starts_with("MM\0*"sv)) return;
  spec.attribute(kExifAttribute, OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(block.size())),
                 block.data());
  spec.attribute("Orientation", orientation_in(block));
}

std::string exif_of(const OIIO::ImageSpec& spec) {
  if (const OIIO::ParamValue* const block = spec.find_attribute(kExifAttribute))
    return {static_cast<const char*>(block->data()), std::size_t(block->datasize())};
  const int orientation = orientation_of(spec);
  if (orientation == 1) return {};
  constexpr std::endian kOrder = std::endian::little;
  std::string tiff("II*\0", 4);
  append_bytes(tiff, std::uint32_t(kTiffHeader), kOrder);
  append_bytes(tiff, std::uint16_t(1), kOrder);  // entries
  append_bytes(tiff, kOrientationTag, kOrder);
  append_bytes(tiff, kShort, kOrder);
  append_bytes(tiff, std::uint32_t(1), kOrder);  // values
  append_bytes(tiff, std::uint32_t(orientation), kOrder);
  append_bytes(tiff, std::uint32_t(0), kOrder);  // no other directory
  return tiff;
}

void read_png_exif(const std::filesystem::path& path, OIIO::ImageSpec& spec) {
  constexpr std::size_t kSignature = 8, kChunkHead = 8, kAroundChunk = 12;
  std::ifstream file(path, std::ios::binary);
  std::string head(kChunkHead, '\0');
  for (std::uint64_t at = kSignature;;) {
    file.seekg(std::streamoff(at));
    if (!file.read(head.data(), std::streamsize(head.size()))) return;
    const auto bytes = from_bytes<std::uint32_t>(head.data(), std::endian::big);
    if (head.compare(4, 4, "IEND") == 0) return;
    if (head.compare(4, 4, "eXIf") == 0) {
      std::string block(bytes, '\0');
      if (file.read(block.data(), std::streamsize(bytes))) set_exif(spec, block);
      return;
    }
    at += kAroundChunk + bytes;
  }
}

void add_png_exif(std::vector<unsigned char>& png, const OIIO::ImageSpec& spec) {
  constexpr std::size_t kAfterHeader = 8 + 12 + 13;  // signature and the chunk IHDR
  const std::string block = exif_of(spec);
  if (block.empty() || png.size() < kAfterHeader) return;
  std::string chunk;
  append_bytes(chunk, std::uint32_t(block.size()), std::endian::big);
  const std::string checked = "eXIf" + block;
  chunk += checked;
  append_bytes(chunk, png_checksum(checked), std::endian::big);
  png.insert(png.begin() + kAfterHeader, chunk.begin(), chunk.end());
}

}  // namespace onmesh
