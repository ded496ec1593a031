#include "onmesh/image/image.h"

namespace onmesh {

std::vector<int> Image::range_channels() const {
  std::vector<int> result;
  for (int c = 0; c < channels; ++c)
    if (c != alpha_channel) result.push_back(c);
  return result;
}

Image make_image(int width, int height, int channels) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.pixels.assign(std::size_t(width) * std::size_t(height) * std::size_t(channels), 0.0F);
  return image;
}

}  // namespace onmesh
