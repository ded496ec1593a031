// What an image was in its file, and the conversions between native pixels and float (internal:
// included by the image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

using SampleType = OIIO::TypeDesc::BASETYPE;

/// `native` holds the file's pixels (row-major, channels interleaved, each in its own type) only if
/// float cannot give them back: 8 and 16 bit integers, half and float can.
struct Image::Source {
  OIIO::ImageSpec spec;
  std::string format;             ///< OpenImageIO's name: "png", "openexr", ...
  std::vector<SampleType> types;  ///< one per channel
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

/// An image file opened for reading, its header checked against the limits.
class ImageReader {
 public:
  /// \throw as read_image
  explicit ImageReader(const std::filesystem::path& path);
  ~ImageReader();

  const OIIO::ImageSpec& spec() const { return spec_; }
  const std::string& format() const { return format_; }
  const std::vector<SampleType>& types() const { return types_; }

  /// Hand over all rows from the top, some at a time: native pixels, first row, number of rows.
  /// \throw InputError if the file ends early or is damaged
  void read(const std::function<void(std::span<const std::byte>, int, int)>& take);

 private:
  std::filesystem::path path_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  std::string format_;
  std::vector<SampleType> types_;
};

/// Rows to read or write at a time: whole rows of tiles.
int rows_at_a_time(const OIIO::ImageSpec& spec);

}  // namespace onmesh
