#include "onmesh/image/layers.h"

#include <algorithm>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh {
namespace {

/// What stands before the last dot.
std::string layer_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

std::string last_part(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return lower_case(dot == std::string::npos ? channel : channel.substr(dot + 1));
}

/// Layers' names in the order of the channels, the empty one for channels without.
std::vector<std::string> layers_of(const Image& image) {
  std::vector<std::string> layers;
  for (const std::string& channel : image.channel_names) {
    const std::string layer = layer_of(channel);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

std::string list_of(const std::vector<std::string>& layers) {
  std::string list;
  for (const std::string& layer : layers) {
    if (layer.empty()) continue;
    if (!list.empty()) list += ", ";
    list += layer;
  }
  return one_line(list);
}

/// The number of the layer's channel with this last part of its name; -1 if there is none.
int find_channel(const Image& image, const std::string& layer, const std::string& part) {
  for (std::size_t c = 0; c < image.channel_names.size(); ++c) {
    const std::string& name = image.channel_names[c];
    if (layer_of(name) == layer && last_part(name) == part) return int(c);
  }
  return -1;
}

/// R G B (A) or Y (A); empty if the layer has neither.
std::vector<int> colours_of(const Image& image, const std::string& layer) {
  for (const std::vector<const char*>& names :
       {std::vector<const char*>{"r", "g", "b"}, std::vector<const char*>{"y"}}) {
    std::vector<int> channels;
    for (const char* const name : names) channels.push_back(find_channel(image, layer, name));
    if (std::find(channels.begin(), channels.end(), -1) != channels.end()) continue;
    if (const int alpha = find_channel(image, layer, "a"); alpha >= 0) channels.push_back(alpha);
    return channels;
  }
  return {};
}

std::vector<int> channels_of(const Image& image, const std::string& layer) {
  std::vector<int> channels = colours_of(image, layer);
  if (!channels.empty()) return channels;
  for (std::size_t c = 0; c < image.channel_names.size(); ++c)
    if (layer_of(image.channel_names[c]) == layer) channels.push_back(int(c));
  return channels;
}

std::vector<int> all_channels(const Image& image) {
  std::vector<int> channels;
  for (int c = 0; c < image.channels; ++c) channels.push_back(c);
  return channels;
}

}  // namespace

std::vector<int> layer_channels(const Image& image, const std::string& layer) {
  const std::vector<std::string> layers = layers_of(image);
  if (!layer.empty()) {
    std::vector<int> channels = channels_of(image, layer);
    const auto whole = std::find(image.channel_names.begin(), image.channel_names.end(), layer);
    if (channels.empty() && whole != image.channel_names.end())
      channels.push_back(int(whole - image.channel_names.begin()));
    if (!channels.empty()) return channels;
    const std::string list = list_of(layers);
    throw InputError("it has no layer '" + layer + "'" +
                     (list.empty() ? ": it has no layers" : "; it has " + list));
  }
  if (std::vector<int> own = colours_of(image, ""); !own.empty()) return own;
  if (image.channel_names.empty() || (image.channels <= 4 && layers.size() == 1))
    return all_channels(image);
  if (layers.size() == 1) return channels_of(image, layers[0]);
  const bool has_own = std::find(layers.begin(), layers.end(), "") != layers.end();
  if (has_own && image.channels <= 4) return all_channels(image);
  throw InputError("none of its layers is the image itself: choose one of " + list_of(layers));
}

}  // namespace onmesh
