#include "onmesh/image/file_format.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/image/exif.h"
#include "onmesh/image/webp.h"

namespace onmesh {
namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

const std::vector<ImageFormat>& formats() {
  static const std::vector<ImageFormat> kFormats = {
      {"png", {".png"}, {TypeDesc::UINT8, TypeDesc::UINT16}, {1, 2, 3, 4}, true, true, true},
      {"jpeg", {".jpg", ".jpeg", ".jpe"}, {TypeDesc::UINT8}, {1, 3}, false, true, true},
      {"tiff",
       {".tif", ".tiff"},
       {TypeDesc::UINT8, TypeDesc::INT8, TypeDesc::UINT16, TypeDesc::INT16, TypeDesc::FLOAT,
        TypeDesc::INT32, TypeDesc::UINT32, TypeDesc::DOUBLE},
       {},
       true,
       true,
       false},
      {"openexr",
       {".exr"},
       {TypeDesc::HALF, TypeDesc::FLOAT, TypeDesc::UINT32},
       {},
       true,
       true,
       false},
      {"webp", {".webp"}, {TypeDesc::UINT8}, {3, 4}, true, true, true},
      {"targa", {".tga"}, {TypeDesc::UINT8}, {1, 3, 4}, true, false, true},
      {"bmp", {".bmp"}, {TypeDesc::UINT8}, {1, 3, 4}, true, false, true},
      {"pnm", {".ppm", ".pgm", ".pnm"}, {TypeDesc::UINT8}, {1, 3}, true, false, true},
      {"sgi", {".sgi"}, {TypeDesc::UINT8, TypeDesc::UINT16}, {1, 2, 3, 4}, true, false, false},
      {"hdr", {".hdr"}, {TypeDesc::FLOAT}, {3}, false, false, true},
  };
  return kFormats;
}

/// The poorest type of the format that holds `wanted`, else its richest.
SampleType nearest_type(const ImageFormat& format, SampleType wanted) {
  const auto& types = format.types;
  if (std::find(types.begin(), types.end(), wanted) != types.end()) return wanted;
  for (const SampleType type : types)
    if (holds(type, wanted)) return type;
  for (auto type = types.rbegin(); type != types.rend(); ++type)
    if (TypeDesc(*type).is_floating_point()) return *type;
  return types.back();
}

/// Settings that describe the source's encoding rather than the image, or that no longer hold.
void drop_stale_attributes(OIIO::ImageSpec& spec, const Image::Source& source,
                           const ImageFormat& format) {
  for (const char* name :
       {"oiio:BitsPerSample", "oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor",
        "oiio:subimages", "textureformat", "openexr:levelmode", "openexr:roundingmode",
        "openexr:chunkCount", "openexr:dwaCompressionLevel", "tiff:ColorSpace",
        "tiff:PhotometricInterpretation", "tiff:Compression", "thumbnail_image"})
    spec.erase_attribute(name);
  if (source.format != format.name) spec.erase_attribute("compression");
  if (format.name == "openexr") spec.erase_attribute("ICCProfile");  // else OpenImageIO prints
  if (format.name != "png" && format.name != "webp") spec.erase_attribute(kExifAttribute);
  if (format.name != "webp") spec.erase_attribute(kXmpAttribute);
  if (!format.holds_orientation) spec.erase_attribute("Orientation");
}

bool has_float(const std::vector<SampleType>& types) {
  return std::find(types.begin(), types.end(), TypeDesc::FLOAT) != types.end();
}

bool is_mixed(const std::vector<SampleType>& types) {
  return std::any_of(types.begin(), types.end(), [&](SampleType t) { return t != types[0]; });
}

/// How hard zlib tries, of 9: a third of the time of the usual 6 for files 5 % larger at most.
constexpr int kZlibLevel = 3;

/// Keep a compression that loses nothing.
void choose_compression(OIIO::ImageSpec& spec, const ImageFormat& format,
                        const std::vector<SampleType>& types) {
  std::string compression(spec.get_string_attribute("compression"));
  if (format.name == "jpeg") {
    const int quality = spec.get_int_attribute("CompressionQuality", 95);
    spec.attribute("compression", "jpeg:" + std::to_string(std::max(quality, 95)));
    if (!spec.find_attribute("jpeg:subsampling")) spec.attribute("jpeg:subsampling", "4:4:4");
  } else if (format.name == "tiff") {
    const bool lossless = compression == "none" || compression == "lzw" || compression == "zip" ||
                          compression == "packbits";
    spec.attribute("compression", lossless ? compression : "zip");
    spec.attribute("tiff:zipquality", kZlibLevel);
  } else if (format.name == "png") {
    spec.attribute("png:compressionLevel", kZlibLevel);
  } else if (format.name == "openexr") {
    const bool lossless = compression == "none" || compression == "rle" || compression == "zip" ||
                          compression == "zips" || compression == "piz" ||
                          (compression == "pxr24" && !has_float(types));
    spec.attribute("compression", lossless ? compression : "zip");
  }
}

/// Where the pixels lie in the plane, as far as the format tells.
void place_in_plane(const ImageWindows& windows, const ImageFormat& format,
                    const OIIO::ImageSpec& was, const OIIO::ImageOutput& output,
                    OIIO::ImageSpec& spec) {
  const PixelWindow &data = windows.data, &display = windows.display;
  const bool fits = output.supports("origin") &&
                    ((data.x >= 0 && data.y >= 0) || output.supports("negativeorigin"));
  if (!fits) return;
  spec.x = data.x;
  spec.y = data.y;
  spec.full_x = display.x;
  spec.full_y = display.y;
  spec.full_width = display.width;
  spec.full_height = display.height;
  if (format.name != "tiff" || data != data_window(was)) return;
  spec.full_x = was.full_x;
  spec.full_y = was.full_y;
  spec.full_width = was.full_width;
  spec.full_height = was.full_height;
}

/// Whether a texel that is no pixel of the data window is anything but 0.
bool has_texels_outside(const Image& image, const ImageWindows& windows) {
  const std::size_t channels = std::size_t(image.channels), width = std::size_t(image.width);
  const auto is_zero = [](float value) { return std::bit_cast<std::uint32_t>(value) == 0; };
  for (int row = 0; row < image.height; ++row) {
    const SharedRow inside = shared_row(windows.display, windows.data, row);
    const float* const values = image.pixels.data() + std::size_t(row) * width * channels;
    const std::size_t first = inside.count == 0 ? width : inside.from % width;
    if (!std::all_of(values, values + first * channels, is_zero) ||
        !std::all_of(values + std::min(first + inside.count, width) * channels,
                     values + width * channels, is_zero))
      return true;
  }
  return false;
}

}  // namespace

const ImageFormat& image_format(const fs::path& name) {
  const std::string extension = lower_case(name.extension().string());
  for (const ImageFormat& format : formats())
    for (const char* known : format.extensions)
      if (extension == known) return format;
  throw FileError(name.string() + ": cannot write images of type \"" + extension +
                  "\"; use .png, .jpg, .tif, .exr, .webp, .tga, .bmp, .ppm, .sgi or .hdr");
}

std::unique_ptr<OIIO::ImageOutput> make_output(const ImageFormat& format) {
  return format.name == "webp" ? make_webp_output() : OIIO::ImageOutput::create(format.name);
}

const Image::Source* matching_source(const Image& image) {
  if (!image.source) return nullptr;
  const Image::Source& source = *image.source;
  const PixelWindow display = display_window(source.spec, source.format);
  const bool matches = display.width == image.width && display.height == image.height &&
                       int(source.types.size()) == image.channels;
  return matches ? &source : nullptr;
}

ImageWindows source_windows(const Image& image) {
  const PixelWindow plain{0, 0, image.width, image.height};
  const Image::Source* const source = matching_source(image);
  if (source == nullptr) return {plain, plain};
  return {data_window(source->spec), display_window(source->spec, source->format)};
}

ImageWindows output_windows(const ImageFormat& format, const Image& image) {
  ImageWindows windows = source_windows(image);
  if (windows.are_equal()) return windows;
  const PixelWindow plain{0, 0, image.width, image.height};
  if (format.name != "openexr") return {plain, plain};
  if (has_texels_outside(image, windows)) windows.data = around_both(windows.data, windows.display);
  return windows;
}

bool holds(SampleType to, SampleType from) {
  if (to == from) return true;
  const auto bits = [](SampleType t) -> int {  // bits of precision
    switch (t) {
      case TypeDesc::UINT8:
      case TypeDesc::INT8:
        return 8;
      case TypeDesc::UINT16:
      case TypeDesc::INT16:
        return 16;
      case TypeDesc::UINT32:
      case TypeDesc::INT32:
        return 32;
      case TypeDesc::HALF:
        return 11;
      case TypeDesc::FLOAT:
        return 24;
      case TypeDesc::DOUBLE:
        return 53;
      default:
        return 64;
    }
  };
  const auto real = [](SampleType t) { return TypeDesc(t).is_floating_point(); };
  if (bits(to) < bits(from)) return false;
  if (real(to)) return true;
  return !real(from) && TypeDesc(to).is_signed() == TypeDesc(from).is_signed();
}

std::vector<SampleType> choose_types(const ImageFormat& format, const Image& image,
                                     const ImageWriteOptions& options) {
  std::vector<SampleType> types(std::size_t(image.channels), TypeDesc::FLOAT);
  const bool like_source =
      image.source && int(image.source->types.size()) == image.channels && !options.force_float;
  if (options.bits != 0 && !options.force_float) {
    std::fill(types.begin(), types.end(), options.bits <= 8 ? TypeDesc::UINT8 : TypeDesc::UINT16);
  } else if (like_source) {
    types = image.source->types;
  }
  for (SampleType& type : types) type = nearest_type(format, type);
  if (is_mixed(types) && format.name != "openexr")
    std::fill(types.begin(), types.end(), nearest_type(format, TypeDesc::FLOAT));
  return types;
}

OIIO::ImageSpec output_spec(const ImageFormat& format, const Image& image,
                            const std::vector<SampleType>& types, const ImageWindows& windows,
                            const OIIO::ImageOutput& output) {
  const PixelWindow& data = windows.data;
  OIIO::ImageSpec spec(data.width, data.height, image.channels, TypeDesc(types[0]));
  // The values are what the file holds, never multiplied with alpha or divided by it.
  const bool unassociated = !image.source ||
                            image.source->spec.get_int_attribute("oiio:UnassociatedAlpha") != 0 ||
                            format.name != "tiff";
  if (image.source) {
    const OIIO::ImageSpec& was = image.source->spec;
    spec.extra_attribs = was.extra_attribs;
    drop_stale_attributes(spec, *image.source, format);
    if (output.supports("tiles") && was.tile_width % 16 == 0 && was.tile_height % 16 == 0) {
      spec.tile_width = was.tile_width;
      spec.tile_height = was.tile_height;
      spec.tile_depth = was.tile_depth;
    }
    place_in_plane(windows, format, was, output, spec);
  }
  spec.alpha_channel = image.alpha_channel;
  if (int(image.channel_names.size()) == image.channels)
    spec.channelnames.assign(image.channel_names.begin(), image.channel_names.end());
  else if (image.channels == 1)
    spec.channelnames = {"Y"};
  if (is_mixed(types)) spec.channelformats.assign(types.begin(), types.end());
  spec.erase_attribute("oiio:UnassociatedAlpha");
  if (unassociated) spec.attribute("oiio:UnassociatedAlpha", 1);
  // Else OpenImageIO writes what memory happens to hold; this is the format's own word for none.
  if (format.name == "sgi" && spec.get_string_attribute("ImageDescription").empty())
    spec.attribute("ImageDescription", "no name");
  choose_compression(spec, format, types);
  return spec;
}

}  // namespace onmesh
