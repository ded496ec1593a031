#include "onmesh/image/image_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "onmesh/base/error.h"

namespace onmesh {
namespace {

constexpr int kLargestSide = 32768;
constexpr std::uint64_t kMostValues = std::uint64_t(1) << 32;  // 16 GB of float

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": " + why);
}

/// Library messages come with line breaks and may be empty.
std::string one_line(std::string text, const std::string& otherwise) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
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
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  input_ = OIIO::ImageInput::open(path.string(), &wishes);
  if (!input_)
    refuse(path, "not a readable image: " + one_line(OIIO::geterror(), "unknown format"));
  spec_ = input_->spec();
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
