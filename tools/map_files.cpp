#include "map_files.h"

#include <algorithm>

#include "colour_spaces.h"
#include "guides.h"
#include "onmesh/base/error.h"

namespace onmesh::tools {

std::vector<MapFiles> maps_of_files(const std::vector<std::string>& files) {
  std::vector<MapFiles> maps;
  for (const std::string& file : files) {
    const NamedTexture texture = split_texture(file);
    const auto same = std::find_if(maps.begin(), maps.end(),
                                   [&](const MapFiles& m) { return m.name == texture.map; });
    MapFiles& map = same != maps.end() ? *same : maps.emplace_back();
    map.name = texture.map;
    map.files.push_back(texture.map.empty() ? file : file.substr(texture.map.size() + 1));
    if (is_reserved_guide(texture.map))
      throw UsageError("--texture: " + file + ": '" + texture.map + "' is a guide's name");
  }
  const bool some_have_none =
      std::any_of(maps.begin(), maps.end(), [](const MapFiles& m) { return m.name.empty(); });
  if (maps.size() > 1 && some_have_none)
    throw UsageError("--texture: " + maps.back().files[0] +
                     ": of several maps all have a name: MAP=FILE");
  return maps;
}

}  // namespace onmesh::tools
