// The image formats that are written, and how an image is put into each (internal: included by the
// image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/image/image_io.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {

struct ImageFormat {
  std::string name;                     ///< OpenImageIO's
  std::vector<const char*> extensions;  ///< lower case
  std::vector<SampleType> types;        ///< what it holds, poorest first
  std::vector<int> channels;            ///< channel counts it holds; empty = any
  bool lossless;
  bool in_memory;  ///< encode in memory: its writer misses or cannot survive a full disk
};

/// The format that the file's extension names.
/// \throw FileError if it is none of ours
const ImageFormat& image_format(const std::filesystem::path& path);

/// Whether every value of type `from` has a value of its own in type `to`.
bool holds(SampleType to, SampleType from);

/// The type of every channel in the file: the source's or what the options ask for, as near as the
/// format comes to it.
std::vector<SampleType> choose_types(const ImageFormat& format, const Image& image,
                                     const ImageWriteOptions& options);

/// What OpenImageIO is told to write: names, metadata, tiles and compression of the source as far
/// as they fit the format and lose nothing.
OIIO::ImageSpec output_spec(const ImageFormat& format, const Image& image,
                            const std::vector<SampleType>& types, const OIIO::ImageOutput& output);

}  // namespace onmesh
