#include "onmesh/image/image_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/image/check_content.h"
#include "onmesh/image/exif.h"
#include "onmesh/image/several_images.h"
#include "onmesh/image/webp.h"

namespace onmesh {
namespace {

void check_readable(const ImagePlace& place) {
  const std::filesystem::path& path = place.path;
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
    refuse_image(place.name, "the file is empty");
}

/// "(default), diffuse, specular": what precedes the last dot in the names of channels, if there
/// are several of it; at most eight.
std::string layers_of(const OIIO::ImageSpec& spec) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::string> layers;
  for (const std::string& channel : spec.channelnames) {
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "(default)" : channel.substr(0, dot);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  if (layers.size() < 2) return {};
  std::string text;
  for (std::size_t i = 0; i < std::min(layers.size(), kMostNamed); ++i)
    text += (i == 0 ? "" : ", ") + layers[i];
  return layers.size() > kMostNamed ? text + " and more" : text;
}

}  // namespace

int rows_at_a_time(const OIIO::ImageSpec& spec) {
  constexpr int kRows = 256;
  if (spec.tile_width == 0 || spec.tile_height < 1) return kRows;
  return spec.tile_height * std::max(1, kRows / spec.tile_height);
}

ImageReader::~ImageReader() = default;

ImageReader::ImageReader(const ImagePlace& place) : place_(place) {
  open();
  check_header();
  check_single_image(place_, *input_, warnings_);
  for (int c = 0; c < spec_.nchannels; ++c)
    types_.push_back(SampleType(spec_.channelformat(c).basetype));
  note_oddities();
}

// Library messages come with line breaks, hold bytes of the file, and may be empty.
std::string ImageReader::message(std::string text, const std::string& otherwise) const {
  const std::string path = place_.path.string(), name = place_.name.string();
  if (path != name) {
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at)) {
      text.replace(at, path.size(), name);
      at += name.size();
    }
  }
  text = one_line(std::move(text));
  return text.empty() ? otherwise : text;
}

void ImageReader::open() {
  const std::filesystem::path& name = place_.name;
  check_readable(place_);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  // Left to itself OpenImageIO tries all its readers, those of films and volumes as well, on what
  // the right one has refused: slow, and not all of them survive damaged files.
  format_ = content_format(place_);
  if (format_.empty()) {
    const std::string foreign = foreign_format(place_);
    if (!foreign.empty())
      refuse_image(name, "is " + foreign + ", which is not read; convert it to PNG, TIFF or EXR");
    refuse_image(name,
                 "not a readable image: not PNG, JPEG, TIFF, EXR, WebP, TGA, BMP, PNM, SGI or HDR");
  }
  check_content(place_, format_);
  input_ = format_ == "webp" ? make_webp_input() : OIIO::ImageInput::create(format_);
  if (!input_)
    refuse_image(name, "not a readable image: " + message(OIIO::geterror(), "no reader"));
  if (!input_->open(place_.path.string(), spec_, wishes))
    refuse_image(name, "not a readable image: " + message(input_->geterror(), "no reason given"));
  format_ = input_->format_name();
  if (format_ == "png") read_png_exif(place_.path, spec_);
}

void ImageReader::check_header() {
  const std::filesystem::path& name = place_.name;
  check_image_size(name, spec_.width, spec_.height, spec_.nchannels);
  if (spec_.deep) refuse_image(name, "deep images cannot be filtered; flatten it first");
  if (spec_.depth > 1) refuse_image(name, "volume images cannot be filtered");
  windows_ = {data_window(spec_), display_window(spec_, format_)};
  check_image_size(name, windows_.display.width, windows_.display.height, spec_.nchannels);
  refuse_bomb();
  if (overlap_of(windows_.data, windows_.display).is_empty())
    refuse_image(name, "the file has no pixels inside its display window");
  // There the order of rows is part of the format, and those that run otherwise are hardly ever
  // met.
  if (format_ == "hdr" && orientation_of(spec_) != 1)
    refuse_image(name, "its rows do not run from left to right and top to bottom; save it anew");
}

/// Images inside other files come from anywhere: a few bytes must not become gigabytes.
void ImageReader::refuse_bomb() const {
  if (place_.path == place_.name) return;
  constexpr double kAlways = 4096.0 * 4096 * 3, kPerByte = 256;  // values
  std::error_code none;
  const double bytes = double(std::filesystem::file_size(place_.path, none));
  const double values = double(windows_.display.width) * windows_.display.height * spec_.nchannels;
  if (values > kAlways && values > kPerByte * bytes) {
    refuse_image(place_.name,
                 std::to_string(windows_.display.width) + " x " +
                     std::to_string(windows_.display.height) + " pixels are too many for " +
                     std::to_string(std::uint64_t(bytes)) + " bytes inside another file");
  }
}

void ImageReader::note_oddities() {
  if (const int orientation = orientation_of(spec_); orientation != 1)
    warnings_.push_back(
        "pixels are taken as they are stored, as modelling programs do: the orientation tag " +
        std::to_string(orientation) + " is kept, not followed");
  if (!windows_.are_equal())
    warnings_.push_back("the texture is the display window, " + window_text(windows_.display) +
                        "; there are pixels of the data window only, " +
                        window_text(windows_.data));
  const bool is_placed = spec_.x != 0 || spec_.y != 0 || spec_.full_width != spec_.width ||
                         spec_.full_height != spec_.height;
  if (format_ == "tiff" && is_placed)
    warnings_.emplace_back(
        "the texture is all pixels that are stored; their place on a page is "
        "kept, not followed");
  if (const std::string layers = layers_of(spec_); !layers.empty())
    warnings_.push_back("it has several layers (" + one_line(layers) +
                        "), of which one is filtered at a time");
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
      const std::string why = message(input_->geterror(), "no reason given");
      refuse_image(place_.name, "the file is truncated or damaged: " + why);
    }
    take(std::span(buffer).first(row_bytes * std::size_t(rows)), row, rows);
  }
}

}  // namespace onmesh
