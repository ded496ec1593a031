#include "onmesh/filter/surface_textures.h"

#include <map>
#include <utility>

namespace onmesh {

void make_uvs_local(const std::vector<TextureTile>& tiles, const std::vector<Index>& tile_of_face,
                    TriangleMesh& mesh) {
  if (tiles.size() == 1 && tiles[0].column == 0 && tiles[0].row == 0) return;
  std::map<std::pair<Index, Index>, Index> numbers;  // of (tile, UV)
  std::vector<Vec2> uvs;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index tile = tile_of_face[f];
    if (tile == kNone || !mesh.has_uvs(f)) {
      mesh.face_uvs[f] = {kNone, kNone, kNone};
      continue;
    }
    const Vec2 origin(tiles[tile].column, tiles[tile].row);
    for (Index& uv : mesh.face_uvs[f]) {
      const auto [at, is_new] = numbers.try_emplace({tile, uv}, Index(uvs.size()));
      if (is_new) uvs.push_back(mesh.uvs[uv] - origin);
      uv = at->second;
    }
  }
  mesh.uvs = std::move(uvs);
}

std::vector<TexelTile> texel_tiles(const std::vector<TextureTile>& tiles) {
  std::vector<TexelTile> result;
  for (const TextureTile& tile : tiles)
    result.push_back({tile.image->width, tile.image->height, tile.wrap});
  return result;
}

SurfaceTextures one_texture(const Image& image, const FilterOptions& options) {
  SurfaceTextures textures;
  textures.tiles = {{&image, options.wrap, 0, 0, {}}};
  for (const bool carries : options.faces) textures.tile_of_face.push_back(carries ? 0 : kNone);
  return textures;
}

}  // namespace onmesh
