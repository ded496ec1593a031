// The textures of an atlas, or its size, and what faces have of it: what map, sample, distance and
// info take.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "arguments.h"
#include "inputs.h"
#include "onmesh/atlas/texel_map.h"
#include "texture_set.h"

namespace onmesh::tools {

/// Adds --texture, --resolution, --material and --wrap.
void add_atlas_options(boost::program_options::options_description& options);
bool has_atlas_option(const Arguments& arguments);

/// An atlas of one or several textures.
struct Atlas {
  TextureSet set;                     ///< one without a path if a resolution was given
  std::vector<Image> images;          ///< per texture; empty if a resolution was given
  std::vector<TexelTile> tiles;       ///< per texture
  TriangleMesh mesh;                  ///< the mesh with UVs of each face's own tile
  std::vector<std::string> warnings;  ///< what is odd about the images' files

  std::vector<const Image*> image_pointers() const;
  /// Of the whole atlas, empty or not.
  TexelMap map() const { return make_texel_map(mesh, tiles, set.tile_of_face); }
};

/// --resolution WxH, or the sizes of the textures that -t or the mesh's materials name, on the
/// faces that filter would choose: see choose_textures().
/// \param texture the option's name where --texture is something else
/// \throw UsageError if both are given
Atlas read_atlas(const Arguments& arguments, const TriangleMesh& mesh,
                 const std::string& texture = "texture");

/// The atlas of textures that are chosen already.
Atlas read_atlas(TextureSet set, const TriangleMesh& mesh, Wrap wrap);

/// The texels of the atlas.
/// \throw InputError if none is covered
TexelMap covered_map(const InputMesh& input, const Atlas& atlas);

/// The textures as the filter takes them.
/// \pre images outlive them
SurfaceTextures surface_textures(const TextureSet& set, const std::vector<Image>& images,
                                 Wrap wrap);

/// A value per channel of every texel, as one image per tile.
std::vector<Image> images_like(const std::vector<TexelTile>& tiles, int channels);

}  // namespace onmesh::tools
