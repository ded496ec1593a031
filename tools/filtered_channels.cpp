#include "filtered_channels.h"

#include <algorithm>
#include <utility>

#include "onmesh/image/channels.h"

namespace onmesh::tools {
namespace {

std::vector<int> channels_of_slot(TextureSlot slot, int channels) {
  if (slot == TextureSlot::occlusion) return {0};
  return channels < 3 ? std::vector<int>{0} : std::vector<int>{1, 2};
}

int colours_of(const Image& image) { return image.channels - (image.alpha_channel >= 0 ? 1 : 0); }

/// Some have alpha, others not, and all else is the same.
bool differ_by_alpha(const std::vector<Image>& images) {
  const auto has_alpha = [](const Image& image) { return image.alpha_channel >= 0; };
  return std::any_of(images.begin(), images.end(), has_alpha) &&
         !std::all_of(images.begin(), images.end(), has_alpha) &&
         std::all_of(images.begin(), images.end(), [&](const Image& image) {
           const bool is_last = !has_alpha(image) || image.alpha_channel == image.channels - 1;
           return is_last && colours_of(image) == colours_of(images[0]);
         });
}

/// The image with an alpha channel of 1 behind the others.
Image as_opaque(const Image& image) {
  Image opaque = make_image(image.width, image.height, image.channels + 1);
  opaque.alpha_channel = image.channels;
  opaque.channel_names = image.channel_names;
  opaque.channel_names.emplace_back("A");
  std::fill(opaque.pixels.begin(), opaque.pixels.end(), 1.F);
  std::vector<int> colours;
  for (int c = 0; c < image.channels; ++c) colours.push_back(c);
  put_channels(image, colours, opaque);
  return opaque;
}

}  // namespace

FilteredChannels choose_channels(TextureSlot slot, const std::vector<Image>& images) {
  FilteredChannels filtered;
  if (slot == TextureSlot::occlusion || slot == TextureSlot::metallic_roughness) {
    for (const Image& image : images) {
      filtered.channels.push_back(channels_of_slot(slot, image.channels));
      filtered.parts.push_back(take_channels(image, filtered.channels.back()));
    }
  } else if (differ_by_alpha(images)) {
    for (const Image& image : images) {
      filtered.channels.emplace_back();
      for (int c = 0; c < image.channels; ++c) filtered.channels.back().push_back(c);
      filtered.parts.push_back(image.alpha_channel >= 0 ? image : as_opaque(image));
    }
  }
  return filtered;
}

void put_together(const FilteredChannels& filtered, const std::vector<Image>& images,
                  std::vector<Image>& results) {
  for (std::size_t i = 0; i < filtered.parts.size(); ++i) {
    Image whole = images[i];
    put_channels(results[i], filtered.channels[i], whole);
    results[i] = std::move(whole);
  }
}

}  // namespace onmesh::tools
