// Images of any channel count, as float values beside the file's own pixels.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// Values of an image, row-major, top row first, channels interleaved.
///
/// Integer files are scaled to [0,1], float files are as they are. What the file was (depth,
/// channel names, metadata, untouched pixels) travels along, so that writing an image that nobody
/// changed gives the same pixels bit for bit.
struct Image {
  int width = 0;                           ///< texels
  int height = 0;                          ///< texels
  int channels = 0;                        ///< values per texel
  int alpha_channel = -1;                  ///< index of the alpha channel, -1 if there is none
  std::vector<float> pixels;               ///< width * height * channels
  std::vector<std::string> channel_names;  ///< one per channel; empty = Y, R G B, R G B A and so on

  struct Source;  ///< format, depth and metadata of the file: native_pixels.h
  std::shared_ptr<const Source> source;  ///< null for images made in memory

  /// The values of texel row * width + column, one per channel.
  const float* texel(Index i) const {
    return pixels.data() + std::size_t(i) * std::size_t(channels);
  }
  /// The same, to change them.
  float* texel(Index i) { return pixels.data() + std::size_t(i) * std::size_t(channels); }
  /// Channels that take part in colour differences and are filtered: all but alpha.
  std::vector<int> range_channels() const;
};

/// An image in memory, all zero, written as 32-bit float where the format can.
Image make_image(int width, int height, int channels);

}  // namespace onmesh
