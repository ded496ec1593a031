// What an image was in its file, and the conversions between native pixels and float (internal:
// included by the image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <string>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

using SampleType = OIIO::TypeDesc::BASETYPE;

/// What an image was in its file.
struct Image::Source {
  OIIO::ImageSpec spec;
  std::string format;             ///< OpenImageIO's name: "png", "openexr", ...
  std::vector<SampleType> types;  ///< one per channel
  /// The pixels of the file's data window, row-major, channels interleaved, each in its own type.
  /// Empty if the image's float values can give them back: those of 8 and 16 bit integers, half and
  /// float can where every pixel is a texel.
  std::vector<std::byte> native;
};

/// Whether to_float followed by from_float gives every bit pattern back.
bool survives_float(SampleType type);

/// Bytes of one pixel with channels of these types.
std::size_t pixel_bytes(const std::vector<SampleType>& types);

/// Native pixels to float: integers are divided by their largest value, floats are as they are.
void to_float(const std::byte* native, const std::vector<SampleType>& types, std::size_t pixels,
              float* values);

/// Float to native pixels, rounded to nearest and clamped to what the type holds; for integers a
/// NaN becomes 0.
void from_float(const float* values, const std::vector<SampleType>& types, std::size_t pixels,
                std::byte* native);

}  // namespace onmesh
