// Options that several subcommands take: what they are, and how they are read.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <optional>
#include <string>

#include "arguments.h"
#include "inputs.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/distance/backend.h"
#include "onmesh/image/image.h"

namespace onmesh::tools {

/// The value of --wrap.
Wrap wrap_of(const Arguments& arguments);
/// The length that --bridge gives, nothing for none (0, the default).
std::optional<Length> bridge_of(const Arguments& arguments);
/// The length that --weld gives, nothing for its default.
/// \throw UsageError if it is in texels
std::optional<Length> weld_of(const Arguments& arguments);
/// The value of --distance.
DistanceMethod distance_of(const Arguments& arguments);

/// Adds --texture, --resolution, --material and --wrap.
void add_atlas_options(boost::program_options::options_description& options);
/// Adds --weld.
void add_weld_option(boost::program_options::options_description& options);
bool has_atlas_option(const Arguments& arguments);

/// The size of the texture whose atlas is meant, and the faces that carry it.
struct Atlas {
  int width = 0, height = 0;
  std::string texture;  ///< path; empty if a resolution was given
  Image image;          ///< empty if a resolution was given
  TexelMapOptions map;
};

/// --resolution WxH, or the size of --texture; without either that of the texture that the mesh's
/// materials name. Faces are chosen as by filter: see choose_texture().
/// \param texture the option's name where --texture is something else
/// \throw UsageError if both are given, or several textures could be meant
Atlas read_atlas(const Arguments& arguments, const TriangleMesh& mesh,
                 const std::string& texture = "texture");

/// The texels of the atlas.
/// \throw InputError if none is covered
TexelMap covered_map(const InputMesh& input, const Atlas& atlas);

}  // namespace onmesh::tools
