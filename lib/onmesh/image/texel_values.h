// The values of texels that are numbered through several images.
#pragma once

#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// Texels of images one after the other: those of the first image have the numbers from 0 on, row
/// by row, those of the next go on from there.
/// \tparam Pixel float, or const float
template <class Pixel>
class NumberedTexels {
 public:
  NumberedTexels() = default;

  /// The images' own values: they outlive this, are not resized and have the same channels.
  template <class SomeImage>
  void add(SomeImage& image) {
    parts_.push_back({next_, image.pixels.data()});
    next_ += Index(image.width) * Index(image.height);
    channels_ = image.channels;
    range_channels_ = image.range_channels();
    alpha_channel_ = image.alpha_channel;
  }

  /// How many texels there are.
  Index size() const { return next_; }
  /// Values per texel.
  int channels() const { return channels_; }
  /// As Image::range_channels().
  const std::vector<int>& range_channels() const { return range_channels_; }
  /// As Image::alpha_channel.
  int alpha_channel() const { return alpha_channel_; }
  /// The values of a texel, one per channel.
  Pixel* operator[](Index texel) const {
    std::size_t part = 0;
    while (part + 1 < parts_.size() && texel >= parts_[part + 1].first) ++part;
    return parts_[part].pixels + std::size_t(texel - parts_[part].first) * std::size_t(channels_);
  }

 private:
  struct Part {
    Index first;
    Pixel* pixels;
  };

  std::vector<Part> parts_;
  std::vector<int> range_channels_;
  int channels_ = 0, alpha_channel_ = -1;
  Index next_ = 0;
};

/// Values to be changed.
using TexelValues = NumberedTexels<float>;
/// Values to be read.
using ConstTexelValues = NumberedTexels<const float>;

/// Those of one image.
inline TexelValues texels_of(Image& image) {
  TexelValues values;
  values.add(image);
  return values;
}
/// The same, to be read.
inline ConstTexelValues texels_of(const Image& image) {
  ConstTexelValues values;
  values.add(image);
  return values;
}

}  // namespace onmesh
