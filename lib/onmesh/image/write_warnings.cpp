#include "onmesh/image/write_warnings.h"

#include <cmath>
#include <cstdint>
#include <functional>

#include "onmesh/image/exif.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {
namespace {

using OIIO::TypeDesc;
using Warn = std::function<void(const std::string&)>;

const char* type_words(SampleType type) {
  switch (type) {
    case TypeDesc::UINT8:
      return "8-bit integers";
    case TypeDesc::UINT16:
      return "16-bit integers";
    case TypeDesc::HALF:
      return "16-bit floats";
    case TypeDesc::FLOAT:
      return "32-bit floats";
    case TypeDesc::DOUBLE:
      return "64-bit floats";
    case TypeDesc::UINT32:
      return "32-bit integers";
    default:
      return "signed or wide integers";
  }
}

/// Warn where the file's types hold less than the source's (or than the floats that are asked for).
void warn_of_types(const Image& image, const ImageWriteOptions& options,
                   const std::vector<SampleType>& types, const Warn& warn) {
  if (!image.source || options.bits != 0 || int(image.source->types.size()) != image.channels)
    return;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const SampleType was = options.force_float ? TypeDesc::FLOAT : image.source->types[c];
    if (holds(types[c], was)) continue;
    warn(std::string(type_words(was)) + " are written as " + type_words(types[c]) +
         ", the format holds no more");
    return;
  }
}

/// Warn of values that integers do not hold.
void warn_of_values(const Image& image, const std::vector<SampleType>& types, const Warn& warn) {
  std::uint64_t clamped = 0, not_numbers = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (TypeDesc(types[c]).is_floating_point()) continue;
    const float least = TypeDesc(types[c]).is_signed() ? -1.00004F : 0.0F;
    for (std::size_t i = c; i < image.pixels.size(); i += types.size()) {
      const float value = image.pixels[i];
      if (std::isnan(value))
        ++not_numbers;
      else if (value < least || value > 1)
        ++clamped;
    }
  }
  if (clamped > 0)
    warn(std::to_string(clamped) + " values outside [0,1] are clamped, the format holds integers");
  if (not_numbers > 0)
    warn(std::to_string(not_numbers) + " values that are not numbers are written as 0");
}

/// Warn where the source's alpha or colour profile means something else in the format.
void warn_of_meaning(const ImageFormat& format, const Image& image, const Warn& warn) {
  if (!image.source) return;
  const Image::Source& source = *image.source;
  const bool exr = format.name == "openexr", tiff = format.name == "tiff";
  if (image.alpha_channel >= 0) {
    const bool apart = source.spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    const bool multiplied = !apart && (source.format == "openexr" || source.format == "tiff");
    if (exr && apart) warn("colours are not multiplied with alpha as EXR wants it");
    if (!exr && !tiff && multiplied) warn("colours stay multiplied with alpha as in the source");
  }
  if (exr && source.spec.find_attribute("ICCProfile") != nullptr)
    warn("EXR cannot hold the source's ICC profile");
}

/// Warn where the file says less about how its pixels lie than the source did.
void warn_of_place(const ImageFormat& format, const Image& image, const ImageWindows& windows,
                   const Warn& warn) {
  if (!image.source) return;
  const int orientation = orientation_of(image.source->spec);
  if (orientation != 1 && !format.holds_orientation)
    warn("the orientation tag " + std::to_string(orientation) +
         " is lost, the format has none; pixels are as they were stored");
  const ImageWindows were = source_windows(image);
  if (were.are_equal() || windows.data == were.data) return;
  if (format.name != "openexr") {
    warn("the display window is written without the source's data window of " +
         window_text(were.data) + ", the format has none");
    return;
  }
  warn("texels outside the data window of " + window_text(were.data) +
       " have values now: it is written as " + window_text(windows.data));
}

}  // namespace

std::vector<std::string> write_warnings(const ImageFormat& format, const Image& image,
                                        const ImageWriteOptions& options,
                                        const std::vector<SampleType>& types,
                                        const ImageWindows& windows) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& what) { warnings.push_back(what); };
  warn_of_types(image, options, types, warn);
  warn_of_values(image, types, warn);
  warn_of_meaning(format, image, warn);
  warn_of_place(format, image, windows, warn);
  return warnings;
}

}  // namespace onmesh
