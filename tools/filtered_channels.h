// Which channels of the textures are filtered, and how those become one map.
#pragma once

#include <string>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/mesh_io/reading.h"

namespace onmesh::tools {

/// Images in the place of the textures; none if these can be filtered as they are.
struct FilteredChannels {
  std::vector<Image> parts;  ///< per texture
  std::vector<std::vector<int>>
      channels;  ///< of the texture, one per channel of the part that goes back
};

/// What is asked for.
struct ChannelRequest {
  TextureSlot slot = TextureSlot::base_colour;
  std::string layer;         ///< empty: the image itself
  std::vector<bool> opaque;  ///< per texture: whether its alpha means nothing; empty = none
};

/// The channels that textures have for a slot: occlusion R, metallicRoughness G and B (grey if
/// there is no more), else those of a layer, see layer_channels(). An image without alpha beside
/// others that have it counts as opaque; alpha that means nothing stays as it is.
/// \param names of the images, for errors
/// \param warnings receives which images have more channels
/// \throw InputError if an image has no such layer
FilteredChannels choose_channels(const ChannelRequest& request, const std::vector<Image>& images,
                                 const std::vector<std::string>& names,
                                 std::vector<std::string>& warnings);

}  // namespace onmesh::tools
