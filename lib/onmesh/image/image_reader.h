// An image file opened for reading, some rows at a time (internal: included by the image sources
// only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "onmesh/image/content_format.h"
#include "onmesh/image/data_window.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {

/// An image file opened for reading, its header checked against the limits.
class ImageReader {
 public:
  /// \throw FileError as read_image()
  /// \throw InputError as read_image()
  explicit ImageReader(const ImagePlace& place);
  ~ImageReader();

  const OIIO::ImageSpec& spec() const { return spec_; }
  /// OpenImageIO's name of the format: "png", "openexr", ...
  const std::string& format() const { return format_; }
  /// The type of every channel.
  const std::vector<SampleType>& types() const { return types_; }
  /// What rows are of, and what of them is the texture.
  const ImageWindows& windows() const { return windows_; }
  /// What is odd about the file, without its name.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Hand over all rows of the data window from the top, some at a time.
  ///
  /// \param take called with native pixels, the first row and the number of rows
  /// \throw InputError if the file ends early or is damaged
  void read(const std::function<void(std::span<const std::byte>, int, int)>& take);

 private:
  void open();
  void check_header();
  void refuse_bomb() const;
  void note_oddities();
  /// A library's message in one line, with the image's name for that of the place.
  std::string message(std::string text, const std::string& otherwise) const;

  ImagePlace place_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  std::string format_;
  std::vector<SampleType> types_;
  ImageWindows windows_;
  std::vector<std::string> warnings_;
};

/// Rows to read or write at a time: whole rows of tiles.
int rows_at_a_time(const OIIO::ImageSpec& spec);

}  // namespace onmesh
