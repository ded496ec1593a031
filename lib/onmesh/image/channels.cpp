#include "onmesh/image/channels.h"

namespace onmesh {

Image take_channels(const Image& image, const std::vector<int>& channels) {
  Image part = make_image(image.width, image.height, int(channels.size()));
  part.channel_names.clear();
  for (const int c : channels) {
    const auto number = std::size_t(c);
    part.channel_names.push_back(number < image.channel_names.size() ? image.channel_names[number]
                                                                     : std::to_string(c));
  }
  const std::size_t texels = std::size_t(image.width) * std::size_t(image.height);
  for (std::size_t t = 0; t < texels; ++t) {
    for (std::size_t k = 0; k < channels.size(); ++k) {
      part.pixels[t * channels.size() + k] =
          image.pixels[t * std::size_t(image.channels) + std::size_t(channels[k])];
    }
  }
  return part;
}

void put_channels(const Image& part, const std::vector<int>& channels, Image& image) {
  const std::size_t texels = std::size_t(image.width) * std::size_t(image.height);
  for (std::size_t t = 0; t < texels; ++t) {
    for (std::size_t k = 0; k < channels.size(); ++k) {
      image.pixels[t * std::size_t(image.channels) + std::size_t(channels[k])] =
          part.pixels[t * std::size_t(part.channels) + k];
    }
  }
}

}  // namespace onmesh
