// Images of any channel count, as float values beside the file's own pixels.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// Row-major, top row first, channels interleaved. Integer files are scaled to [0,1], float files
/// are as they are. What the file was (depth, channel names, metadata, untouched pixels) travels
/// along, so that writing an image that nobody changed gives the same pixels bit for bit.
struct Image {
  int width = 0, height = 0, channels = 0;
  int alpha_channel = -1;                  ///< index of the alpha channel, -1 if there is none
  std::vector<float> pixels;               ///< width * height * channels
  std::vector<std::string> channel_names;  ///< one per channel; empty = Y, R G B, R G B A and so on

  struct Source;                         ///< the file's format, metadata and native pixels
  std::shared_ptr<const Source> source;  ///< null for images made in memory

  const float* texel(Index i) const {
    return pixels.data() + std::size_t(i) * std::size_t(channels);
  }
  float* texel(Index i) { return pixels.data() + std::size_t(i) * std::size_t(channels); }
  /// Channels that take part in colour differences and are filtered: all but alpha.
  std::vector<int> range_channels() const;
};

/// An image in memory, all zero, written as 32-bit float where the format can.
Image make_image(int width, int height, int channels);

/// The first image of the file. Colours are not multiplied with alpha where the file keeps them
/// apart, and no colour space is converted. Values that are not finite stay as they are. \throw
/// FileError if the file cannot be opened; InputError if it is no image, truncated, empty,
///   larger than 32768 x 32768 (refused before anything is allocated), deep or of several parts
Image read_image(const std::filesystem::path& path);

struct ImageWriteOptions {
  bool force_float = false;  ///< write 32-bit float whatever the source was
  int bits = 0;              ///< 8 or 16: integers of that depth; 0 = as the source
};

/// Write with the source's depth, channel names and metadata (nearest depth that the format holds).
/// Values are rounded to nearest; a pixel equal to the source's value is written as the source's
/// bits. The file is written beside the target, read back and compared (JPEG and HDR: its size
/// only), then renamed. A link is followed, an existing file's permissions are kept.
/// Written are PNG, JPEG (quality 95 without chroma subsampling unless the source says otherwise),
/// TIFF, EXR, TGA, BMP, PNM, SGI and HDR; lossy compression inside TIFF and EXR becomes lossless.
/// \param warnings receives a line when the format cannot hold what the source had (depth)
/// \throw FileError if it cannot be written; InputError if the format cannot hold the channels
///   (JPEG with alpha)
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {},
                 std::vector<std::string>* warnings = nullptr);

/// Throw FileError or InputError now if `path` cannot be written later: unknown extension, missing
/// or read-only folder, is a folder, or the format cannot hold `image`'s channels.
void check_writable_image(const std::filesystem::path& path, const Image& image);

}  // namespace onmesh
