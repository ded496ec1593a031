// The image formats that are written, and how an image is put into each (internal: included by the
// image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "onmesh/image/data_window.h"
#include "onmesh/image/image_io.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {

struct ImageFormat {
  std::string name;                     ///< OpenImageIO's
  std::vector<const char*> extensions;  ///< lower case
  std::vector<SampleType> types;        ///< what it holds, poorest first
  std::vector<int> channels;            ///< channel counts it holds; empty = any
  bool lossless;
  bool holds_orientation;
  bool in_memory;  ///< encode in memory: its writer misses or cannot survive a full disk
};

/// The format that the name's extension names.
/// \throw FileError if it is none of ours
const ImageFormat& image_format(const std::filesystem::path& name);

/// Opens nothing yet; null if the library lacks the format.
std::unique_ptr<OIIO::ImageOutput> make_output(const ImageFormat& format);

/// Whether every value of type `from` has a value of its own in type `to`.
bool holds(SampleType to, SampleType from);

/// The type of every channel in the file: the source's or what the options ask for, as near as the
/// format comes to it.
std::vector<SampleType> choose_types(const ImageFormat& format, const Image& image,
                                     const ImageWriteOptions& options);

/// What OpenImageIO is told to write: names, metadata, tiles and compression of the source as far
/// as they fit the format and lose nothing.
OIIO::ImageSpec output_spec(const ImageFormat& format, const Image& image,
                            const std::vector<SampleType>& types, const ImageWindows& windows,
                            const OIIO::ImageOutput& output);

/// The image's source, if its size and channels are still the image's; else null.
const Image::Source* matching_source(const Image& image);

/// The windows of the image's matching source; else both are the image.
ImageWindows source_windows(const Image& image);

/// The windows of the file: the source's, with the data window grown around the display window if
/// texels outside of it are not 0; both are the image where the format has none.
ImageWindows output_windows(const ImageFormat& format, const Image& image);

}  // namespace onmesh
