// Image files in and out: PNG, JPEG, TIFF, EXR, TGA, BMP, PNM, SGI and HDR.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// Read the first image of a file.
///
/// Colours are not multiplied with alpha where the file keeps them apart, and no colour space is
/// converted. Values that are not finite stay as they are.
/// \throw FileError if the file cannot be opened
/// \throw InputError if it is no image, truncated, empty, larger than 32768 x 32768 (refused before
///   anything is allocated), deep or of several parts
Image read_image(const std::filesystem::path& path);

/// What write_image() is to do otherwise.
struct ImageWriteOptions {
  bool force_float = false;  ///< write 32-bit float whatever the source was
  int bits = 0;              ///< 8 or 16: integers of that depth; 0 = as the source
};

/// Write an image with its source's depth, channel names and metadata, or the nearest depth that
/// the format holds.
///
/// Values are rounded to nearest; one that equals the source's value is written as the source's
/// bits. The file is written beside the target, read back and compared (JPEG and HDR: its size
/// only), then renamed. A link is followed, an existing file's permissions are kept.
/// Written are PNG, JPEG (quality 95 without chroma subsampling unless the source says otherwise),
/// TIFF, EXR, TGA, BMP, PNM, SGI and HDR; lossy compression inside TIFF and EXR becomes lossless.
/// \param warnings receives a line for each thing of the source that the format cannot hold
/// \throw FileError if it cannot be written
/// \throw InputError if the format cannot hold the channels (JPEG with alpha)
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {},
                 std::vector<std::string>* warnings = nullptr);

/// An image and where it goes.
struct ImageFile {
  std::filesystem::path path;    ///< as write_image() takes it
  const Image* image = nullptr;  ///< outlives the call
};

/// Write several images, each as write_image() does, or none: all of them are complete and read
/// back before the first takes its place (commit_all()).
/// \throw as write_image()
void write_images(const std::vector<ImageFile>& files, const ImageWriteOptions& options = {},
                  std::vector<std::string>* warnings = nullptr);

/// Throw now if write_image() could not write `image` to `path` later.
///
/// \throw FileError for an unknown extension, a missing or read-only folder, or if it is a folder
/// \throw InputError if the format cannot hold the image's channels
void check_writable_image(const std::filesystem::path& path, const Image& image);

}  // namespace onmesh
