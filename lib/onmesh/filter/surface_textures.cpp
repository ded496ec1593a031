#include "onmesh/filter/surface_textures.h"

namespace onmesh {

SurfaceTextures one_texture(const Image& image, const FilterOptions& options) {
  SurfaceTextures textures;
  textures.tiles = {{&image, options.wrap, 0, 0, {}}};
  for (const bool carries : options.faces) textures.tile_of_face.push_back(carries ? 0 : kNone);
  return textures;
}

}  // namespace onmesh
