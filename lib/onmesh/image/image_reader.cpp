#include "onmesh/image/image_reader.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/image/check_content.h"

namespace onmesh {
namespace {

/// Library messages come with line breaks, hold bytes of the file, and may be empty.
std::string one_line(std::string text, const std::string& otherwise) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? otherwise : text;
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
  if (!file) {
    throw FileError(path.string() +
                    ": cannot open the image: " + std::strerror(errno ? errno : ENOENT));
  }
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) == 0)
    refuse_image(path, "the file is empty");
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
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  // Left to itself OpenImageIO tries all its readers, those of films and volumes as well, on what
  // the right one has refused: slow, and not all of them survive damaged files.
  const char* const found = format_of_content(path);
  if (found == nullptr)
    refuse_image(path, "not a readable image: not PNG, JPEG, TIFF, EXR, TGA, BMP, PNM, SGI or HDR");
  check_content(path, found);
  input_ = OIIO::ImageInput::create(found);
  if (!input_)
    refuse_image(path, "not a readable image: " + one_line(OIIO::geterror(), "no reader"));
  if (!input_->open(path.string(), spec_, wishes))
    refuse_image(path, "not a readable image: " + one_line(input_->geterror(), "no reason given"));
  format_ = input_->format_name();
  check_image_size(path, spec_.width, spec_.height, spec_.nchannels);
  if (spec_.deep) refuse_image(path, "deep images cannot be filtered; flatten it first");
  if (spec_.depth > 1) refuse_image(path, "volume images cannot be filtered");
  if (spec_.x != spec_.full_x || spec_.y != spec_.full_y || spec_.width != spec_.full_width ||
      spec_.height != spec_.full_height)
    refuse_image(path, "the data window differs from the display window; save the image uncropped");
  if (format_ == "openexr") {
    if (input_->seek_subimage(1, 0))
      refuse_image(path,
                   "the file has several parts; save the part to filter as a file of its own");
    input_->geterror();
    if (!input_->seek_subimage(0, 0))
      refuse_image(path, one_line(input_->geterror(), "cannot be read"));
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
      refuse_image(path_, "the file is truncated or damaged: " + why);
    }
    take(std::span(buffer).first(row_bytes * std::size_t(rows)), row, rows);
  }
}

}  // namespace onmesh
