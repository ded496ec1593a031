#include "onmesh/image/image_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "onmesh/base/byte_order.h"
#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {
namespace {

constexpr int kLargestSide = 32768;
constexpr std::uint64_t kMostValues = std::uint64_t(1) << 32;  // 16 GB of float

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": " + why);
}

/// Library messages come with line breaks, hold bytes of the file, and may be empty.
std::string one_line(std::string text, const std::string& otherwise) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? otherwise : text;
}

void check_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                std::int64_t channels) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || channels < 1) refuse(path, "the image is empty (" + size + ")");
  if (width > kLargestSide || height > kLargestSide)
    refuse(path, "the image is too large: " + size + ", at most 32768 x 32768 is read");
  if (std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels) > kMostValues)
    refuse(path, "the image is too large: " + size + " with " + std::to_string(channels) +
                     " channels, at most 2^32 values are read");
}

/// Walk over a PNG's chunks: libpng prints to stderr when the file ends early, and its dimensions
/// are not checked by anyone before it allocates.
void check_png(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto size = std::filesystem::file_size(path);
  std::array<unsigned char, 24> head{};
  file.read(reinterpret_cast<char*>(head.data()), 8);
  constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (!file || !std::equal(kSignature.begin(), kSignature.end(), head.begin())) return;
  const auto number = [](const unsigned char* b) {
    return std::uint32_t(b[0]) << 24 | std::uint32_t(b[1]) << 16 | std::uint32_t(b[2]) << 8 | b[3];
  };
  for (std::uint64_t at = 8;;) {
    file.seekg(std::streamoff(at));
    file.read(reinterpret_cast<char*>(head.data()), 8);
    if (!file) refuse(path, "the file is truncated");
    const std::uint64_t next = at + 12 + number(head.data());
    if (next > size) refuse(path, "the file is truncated");
    if (std::memcmp(head.data() + 4, "IHDR", 4) == 0) {
      file.read(reinterpret_cast<char*>(head.data()), 8);
      if (file) check_size(path, number(head.data()), number(head.data() + 4), 1);
    } else if (std::memcmp(head.data() + 4, "IEND", 4) == 0) {
      return;
    }
    at = next;
  }
}

/// Walk over an EXR's attributes: OpenEXR makes room for as many bytes as each of them claims to
/// have, and fills it, before it looks whether they are there.
void check_exr(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto size = std::filesystem::file_size(path);
  std::array<unsigned char, 8> head{};
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  constexpr std::array<unsigned char, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
  if (!file || !std::equal(kMagic.begin(), kMagic.end(), head.begin())) return;
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
    const std::uint64_t next =
        std::uint64_t(file.tellg()) + from_bytes<std::uint32_t>(length.data(), std::endian::little);
    if (!file || next > size) break;
    file.seekg(std::streamoff(next));
  }
  refuse(path, "the file is truncated");
}

/// Check an SGI file's header: OpenImageIO takes it for true, whatever the bytes per channel, and
/// looks for every channel of every row in a file that may be too short for them.
void check_sgi(const std::filesystem::path& path) {
  constexpr std::uint64_t kHeader = 512, kTableEntry = 8;  // bytes
  std::array<unsigned char, 12> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!file || head[0] != 0x01 || head[1] != 0xda) return;
  const auto number = [&](std::size_t at) {
    return std::uint64_t(head[at]) << 8 | std::uint64_t(head[at + 1]);
  };
  const bool compressed = head[2] == 1;
  const std::uint64_t bytes = head[3], dimensions = number(4), width = number(6);
  const std::uint64_t height = dimensions > 1 ? number(8) : 1;
  const std::uint64_t channels = dimensions > 2 ? number(10) : 1;
  if (head[2] > 1 || bytes < 1 || bytes > 2 || dimensions < 1 || dimensions > 3)
    refuse(path, "the SGI header is damaged");
  check_size(path, std::int64_t(width), std::int64_t(height), std::int64_t(channels));
  const std::uint64_t rows = height * channels;
  const std::uint64_t least = kHeader + rows * (compressed ? kTableEntry : width * bytes);
  if (std::filesystem::file_size(path) < least) refuse(path, "the file is truncated");
}

/// OpenImageIO's name of the format, by the file's first bytes; null if it is none of ours. TGA has
/// no mark at its start, and none at all if it is old: it may go by the name.
const char* format_of_content(const std::filesystem::path& path) {
  using namespace std::string_view_literals;
  static constexpr std::pair<std::string_view, const char*> kMarks[] = {
      {"\x89PNG"sv, "png"},
      {"\xff\xd8"sv, "jpeg"},
      {"II*\0"sv, "tiff"},
      {"MM\0*"sv, "tiff"},
      {"II+\0"sv, "tiff"},
      {"MM\0+"sv, "tiff"},
      {"\x76\x2f\x31\x01"sv, "openexr"},
      {"BM"sv, "bmp"},
      {"\x01\xda"sv, "sgi"},
      {"#?"sv, "hdr"}};
  constexpr std::string_view kTgaEnd = "TRUEVISION-XFILE.\0"sv;
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kTgaEnd.size(), '\0');
  const auto size = std::streamsize(bytes.size());
  file.read(bytes.data(), size);
  for (const auto& [mark, format] : kMarks)
    if (bytes.starts_with(mark)) return format;
  if (bytes[0] == 'P' && "123456fF"sv.find(bytes[1]) != std::string_view::npos) return "pnm";
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".tga" || extension == ".tpic") return "targa";
  file.clear();
  file.seekg(-size, std::ios::end);
  return file.read(bytes.data(), size) && bytes == kTgaEnd ? "targa" : nullptr;
}

void check_readable(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw FileError(path.string() + ": cannot read the image: it is a folder");
  // Opening a pipe would wait for whoever writes to it.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw FileError(path.string() + ": cannot read the image: it is not a regular file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file && path.string().find("<UDIM>") != std::string::npos) {
    throw FileError(path.string() +
                    ": cannot open the image: the mesh names UDIM tiles, which are not supported; "
                    "split it by tile and give each its image with -t");
  }
  if (!file) {
    throw FileError(path.string() +
                    ": cannot open the image: " + std::strerror(errno ? errno : ENOENT));
  }
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) == 0)
    refuse(path, "the file is empty");
}

}  // namespace

int rows_at_a_time(const OIIO::ImageSpec& spec) {
  constexpr int kRows = 256;
  if (spec.tile_width == 0 || spec.tile_height < 1) return kRows;
  return spec.tile_height * std::max(1, kRows / spec.tile_height);
}

ImageReader::~ImageReader() = default;

ImageReader::ImageReader(const std::filesystem::path& path) : path_(path) {
  check_readable(path);
  check_png(path);
  check_exr(path);
  check_sgi(path);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  // Left to itself OpenImageIO tries all its readers, those of films and volumes as well, on what
  // the right one has refused: slow, and not all of them survive damaged files.
  const char* const found = format_of_content(path);
  if (found == nullptr)
    refuse(path, "not a readable image: not PNG, JPEG, TIFF, EXR, TGA, BMP, PNM, SGI or HDR");
  input_ = OIIO::ImageInput::create(found);
  if (!input_) refuse(path, "not a readable image: " + one_line(OIIO::geterror(), "no reader"));
  if (!input_->open(path.string(), spec_, wishes))
    refuse(path, "not a readable image: " + one_line(input_->geterror(), "no reason given"));
  format_ = input_->format_name();
  check_size(path, spec_.width, spec_.height, spec_.nchannels);
  if (spec_.deep) refuse(path, "deep images cannot be filtered; flatten it first");
  if (spec_.depth > 1) refuse(path, "volume images cannot be filtered");
  if (spec_.x != spec_.full_x || spec_.y != spec_.full_y || spec_.width != spec_.full_width ||
      spec_.height != spec_.full_height)
    refuse(path, "the data window differs from the display window; save the image uncropped");
  if (format_ == "openexr") {
    if (input_->seek_subimage(1, 0))
      refuse(path, "the file has several parts; save the part to filter as a file of its own");
    input_->geterror();
    if (!input_->seek_subimage(0, 0)) refuse(path, one_line(input_->geterror(), "cannot be read"));
  }
  for (int c = 0; c < spec_.nchannels; ++c)
    types_.push_back(SampleType(spec_.channelformat(c).basetype));
}

void ImageReader::read(const std::function<void(std::span<const std::byte>, int, int)>& take) {
  const int step = rows_at_a_time(spec_);
  const std::size_t row_bytes = std::size_t(spec_.width) * pixel_bytes(types_);
  std::vector<std::byte> buffer(row_bytes * std::size_t(std::min(step, spec_.height)));
  for (int row = 0; row < spec_.height; row += step) {
    const int rows = std::min(step, spec_.height - row);
    const int begin = spec_.y + row;
    // The type "unknown" asks for the file's own, also where channels differ.
    const bool ok =
        spec_.tile_width > 0
            ? input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, begin, begin + rows, spec_.z,
                                 spec_.z + 1, 0, spec_.nchannels, OIIO::TypeUnknown, buffer.data())
            : input_->read_scanlines(0, 0, begin, begin + rows, spec_.z, 0, spec_.nchannels,
                                     OIIO::TypeUnknown, buffer.data());
    if (!ok || input_->has_error()) {  // some readers return true for rows they made up
      const std::string why = one_line(input_->geterror(), "no reason given");
      refuse(path_, "the file is truncated or damaged: " + why);
    }
    take(std::span(buffer).first(row_bytes * std::size_t(rows)), row, rows);
  }
}

}  // namespace onmesh
