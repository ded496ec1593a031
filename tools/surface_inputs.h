// Mesh and textures as filter and fill take them.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "arguments.h"
#include "colour_spaces.h"
#include "filtered_channels.h"
#include "flags.h"
#include "inputs.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "stopwatch.h"
#include "texture_set.h"

namespace onmesh::tools {

/// Mesh, textures and masks as read, and what is told in the end.
struct SurfaceInputs {
  std::string mesh_path;
  TriangleMesh mesh;
  TextureSet set;
  std::vector<Image> images;               ///< per texture of the set
  std::vector<ColourSpaceChoice> spaces;   ///< of those
  FilteredChannels filtered;               ///< what of them is filtered
  std::vector<Image> masks, sample_masks;  ///< per texture, if they were given
  Wrap wrap = Wrap::repeat;
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;

  /// What the library takes. Refers to the images and masks.
  SurfaceTextures textures() const;
};

/// Adds the options that say which textures and which of their channels: --texture, --material,
/// --layer, --only, --mask-samples, --colorspace, --raw, --wrap, --weld, --slot, --uv-set,
/// --confine.
void add_surface_options(boost::program_options::options_description& options);

/// \param watch times the stages
/// \throw UsageError, FileError, InputError naming option or file
SurfaceInputs read_surface(const Arguments& arguments, Stopwatch& watch);

/// Why no texel of a glTF file can change, which is then written as it is; empty if some can.
std::string why_nothing(const SurfaceInputs& inputs, bool into_gltf);

/// What a stage took that ends now.
StageTime stage(const char* name, Stopwatch& watch);

/// Adds the library's warnings to those of reading, in terms of flags.
void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& warnings);

/// Calls work(), which computes on the mesh read; errors name the file and flags.
template <class Work>
auto working_on(const SurfaceInputs& inputs, Work work) {
  return naming(inputs.mesh_path, [&] { return with_flags(work); });
}

}  // namespace onmesh::tools
