// The part of an image's plane that a file has pixels of (internal: included by the image sources
// only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "onmesh/image/image.h"

namespace onmesh {

/// A rectangle of pixels.
struct PixelWindow {
  int x = 0;       ///< of the first column
  int y = 0;       ///< of the first row
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels

  bool operator==(const PixelWindow&) const = default;
  bool is_empty() const { return width <= 0 || height <= 0; }
  std::int64_t right() const { return std::int64_t(x) + width; }    ///< after the last column
  std::int64_t bottom() const { return std::int64_t(y) + height; }  ///< after the last row
};

/// The pixels in both; an empty one if there are none.
PixelWindow overlap_of(const PixelWindow& a, const PixelWindow& b);

/// The smallest one with all pixels of both.
/// \pre its sides fit an int
PixelWindow around_both(const PixelWindow& a, const PixelWindow& b);

/// "16 x 8 at (-3, 4)".
std::string window_text(const PixelWindow& window);

/// What of the plane the file has pixels of.
PixelWindow data_window(const OIIO::ImageSpec& spec);

/// What of the plane the texture is. Only EXR tells it apart from the data window: positions in a
/// TIFF are those on a page.
/// \param format OpenImageIO's name
PixelWindow display_window(const OIIO::ImageSpec& spec, const std::string& format);

/// How pixels in a file lie to the texels of an image.
struct ImageWindows {
  PixelWindow data, display;
  bool operator==(const ImageWindows&) const = default;
  /// Whether each texel is a pixel and each pixel a texel.
  bool are_equal() const { return data == display; }
};

/// Where a row of pixels goes that two windows share.
struct SharedRow {
  std::size_t from;   ///< first pixel, into the first window
  std::size_t to;     ///< first pixel, into the second
  std::size_t count;  ///< pixels; 0 = none
};

/// The pixels that the row of `from` shares with `to`.
/// \param row counted from the top of `from`
SharedRow shared_row(const PixelWindow& from, const PixelWindow& to, int row);

}  // namespace onmesh
