#include "onmesh/filter/surface_textures.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "onmesh/filter/options.h"

namespace onmesh {

void make_uvs_local(const std::vector<TextureTile>& tiles, const std::vector<Index>& tile_of_face,
                    TriangleMesh& mesh) {
  // How each face reads its tile, by number: tiles and modes.
  const auto reading_of = [&](Index face) {
    const Index tile = tile_of_face[face];
    const WrapModes wrap = mesh.wrap_of(face, tiles[tile].wrap);
    return 9 * std::uint64_t{tile} + 3 * static_cast<std::uint64_t>(wrap.u) +
           static_cast<std::uint64_t>(wrap.v);
  };
  if (tiles.size() == 1 && tiles[0].column == 0 && tiles[0].row == 0) {
    std::optional<std::uint64_t> first;
    bool is_one = true;
    for (Index f = 0; f < mesh.faces.size() && is_one; ++f) {
      if (tile_of_face[f] == kNone) continue;
      if (!first) first = reading_of(f);
      is_one = reading_of(f) == *first;
    }
    if (is_one) return;
  }
  std::map<std::pair<std::uint64_t, Index>, Index> numbers;  // of (reading, UV)
  std::vector<Vec2> uvs;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index tile = tile_of_face[f];
    if (tile == kNone || !mesh.has_uvs(f)) {
      mesh.face_uvs[f] = {kNone, kNone, kNone};
      continue;
    }
    const std::uint64_t reading = reading_of(f);
    const Vec2 origin(tiles[tile].column, tiles[tile].row);
    for (Index& uv : mesh.face_uvs[f]) {
      const auto [at, is_new] = numbers.try_emplace({reading, uv}, Index(uvs.size()));
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
