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

bool has_alpha(const Image& image) { return image.alpha_channel >= 0; }

/// Some have alpha behind their colours, others not, and all else is the same.
bool differ_by_alpha(const std::vector<Image>& images) {
  return std::any_of(images.begin(), images.end(), has_alpha) &&
         !std::all_of(images.begin(), images.end(), has_alpha) &&
         std::all_of(images.begin(), images.end(), [&](const Image& image) {
           const bool is_last = !has_alpha(image) || image.alpha_channel == image.channels - 1;
           return is_last && colours_of(image) == colours_of(images[0]);
         });
}

/// The channels of a layer, but alpha if it means nothing. What stays out is told, but alpha.
std::vector<int> choose_layer(const ChannelRequest& request, const Image& image,
                              const std::string& name, bool is_opaque,
                              std::vector<std::string>& warnings) {
  std::vector<int> chosen;
  try {
    chosen = layer_channels(image, request.layer);
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what() + (request.layer.empty() ? " with --layer" : ""));
  }
  if (int(chosen.size()) < image.channels) {
    std::string list;
    for (const int c : chosen)
      list += (list.empty() ? "" : " ") + image.channel_names[std::size_t(c)];
    const auto others = std::uint64_t(image.channels) - chosen.size();
    warnings.push_back(name + ": the channels " + list + " are filtered, " +
                       count_text(others, "other stays as it is", "others stay as they are"));
  }
  if (is_opaque)
    chosen.erase(std::remove(chosen.begin(), chosen.end(), image.alpha_channel), chosen.end());
  return chosen;
}

Image take(const Image& image, const std::vector<int>& channels) {
  Image part = take_channels(image, channels);
  const auto alpha = std::find(channels.begin(), channels.end(), image.alpha_channel);
  if (has_alpha(image) && alpha != channels.end())
    part.alpha_channel = int(alpha - channels.begin());
  part.source = image.source;  // how many levels its codes have; it is not written
  return part;
}

}  // namespace

FilteredChannels choose_channels(const ChannelRequest& request, const std::vector<Image>& images,
                                 const std::vector<std::string>& names,
                                 std::vector<std::string>& warnings) {
  FilteredChannels filtered;
  const bool by_slot =
      request.slot == TextureSlot::occlusion || request.slot == TextureSlot::metallic_roughness;
  bool are_whole = !by_slot;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const bool is_opaque = !request.opaque.empty() && request.opaque[i];
    filtered.channels.push_back(
        by_slot ? channels_of_slot(request.slot, images[i].channels)
                : choose_layer(request, images[i], names[i], is_opaque, warnings));
    are_whole &= int(filtered.channels[i].size()) == images[i].channels;
  }
  if (are_whole && !differ_by_alpha(images)) return {};
  for (std::size_t i = 0; i < images.size(); ++i)
    filtered.parts.push_back(take(images[i], filtered.channels[i]));
  if (!differ_by_alpha(filtered.parts)) return filtered;
  for (Image& part : filtered.parts)
    if (!has_alpha(part)) part = as_opaque(part);
  return filtered;
}

}  // namespace onmesh::tools
