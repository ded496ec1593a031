#include "review_maps.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "onmesh/image/colour_space.h"

namespace onmesh::tools {

void round_to_codes(Image& image) {
  const int levels = levels_of(image);
  if (levels == 0) return;
  for (float& value : image.pixels)
    value = float(std::round(std::clamp(double(value), 0.0, 1.0) * levels) / levels);
}

void add_input_maps(const SurfaceInputs& inputs, std::vector<std::vector<Image>> runs,
                    Review& review) {
  const InputMap& first = inputs.maps[0];
  review.tile_of_face = first.tile_of_face;
  for (std::size_t t = 0; t < first.count; ++t) {
    const SetTexture& texture = inputs.set.textures[t];
    const std::string name =
        texture.udim > 0 ? std::to_string(texture.udim) : texture.path.filename().string();
    review.tiles.push_back({name, texture.column(), texture.row()});
  }
  for (const InputMap& map : inputs.maps) {
    if (map.has_own_uvs || map.tile_of_face != first.tile_of_face) {
      review.notes.push_back(map.name + ": is on other faces or UVs than " + first.name +
                             " and not shown");
      continue;
    }
    ReviewMap& shown = review.maps.emplace_back();
    shown.name = map.name;
    shown.space = inputs.spaces[map.first].name;
    shown.after.resize(runs.size());
    for (std::size_t i = map.first; i < map.first + map.count; ++i) {
      shown.files.push_back(inputs.set.textures[i].path.filename().string());
      shown.before.push_back(inputs.images[i]);
      for (std::size_t run = 0; run < runs.size(); ++run)
        shown.after[run].push_back(std::move(runs[run][i]));
    }
  }
}

}  // namespace onmesh::tools
