// Which channels of the textures are filtered, and how those become one map.
#pragma once

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

/// The channels that textures have for a slot: occlusion R, metallicRoughness G and B (grey if
/// there is no more), else all. An image without alpha beside others that have it counts as opaque.
FilteredChannels choose_channels(TextureSlot slot, const std::vector<Image>& images);

/// The results as whole textures: channels that were left out are as they were.
/// \param results of the parts, if there are any
void put_together(const FilteredChannels& filtered, const std::vector<Image>& images,
                  std::vector<Image>& results);

}  // namespace onmesh::tools
