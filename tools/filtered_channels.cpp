#include "filtered_channels.h"

#include <algorithm>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/image/channels.h"
#include "onmesh/image/layers.h"

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

FilteredChannels choose_channels(TextureSlot slot, const std::vector<Image>& images,
                                 const std::vector<std::string>& names, const std::string& layer,
                                 std::vector<std::string>& warnings) {
  FilteredChannels filtered;
  const auto take = [&](const Image& image, std::vector<int> channels) {
    Image part = take_channels(image, channels);
    const auto alpha = std::find(channels.begin(), channels.end(), image.alpha_channel);
    if (alpha != channels.end()) part.alpha_channel = int(alpha - channels.begin());
    filtered.parts.push_back(std::move(part));
    filtered.channels.push_back(std::move(channels));
  };
  if (slot == TextureSlot::occlusion || slot == TextureSlot::metallic_roughness) {
    for (const Image& image : images) take(image, channels_of_slot(slot, image.channels));
    return filtered;
  }
  std::vector<std::vector<int>> chosen;
  bool are_whole = true;
  for (std::size_t i = 0; i < images.size(); ++i) {
    try {
      chosen.push_back(layer_channels(images[i], layer));
    } catch (const InputError& error) {
      throw InputError(names[i] + ": " + error.what() + (layer.empty() ? " with --layer" : ""));
    }
    if (int(chosen[i].size()) == images[i].channels) continue;
    are_whole = false;
    std::string list;
    for (const int c : chosen[i])
      list += (list.empty() ? "" : " ") + images[i].channel_names[std::size_t(c)];
    const auto others = std::uint64_t(images[i].channels) - chosen[i].size();
    warnings.push_back(names[i] + ": the channels " + list + " are filtered, " +
                       count_text(others, "other stays as it is", "others stay as they are"));
  }
  if (!are_whole) {
    for (std::size_t i = 0; i < images.size(); ++i) take(images[i], chosen[i]);
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
