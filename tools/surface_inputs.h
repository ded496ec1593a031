// Mesh and textures as filter and fill take them.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <memory>
#include <string>
#include <vector>

#include "arguments.h"
#include "colour_spaces.h"
#include "filtered_channels.h"
#include "flags.h"
#include "inputs.h"
#include "onmesh/filter/guide.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/surface_textures.h"
#include "stopwatch.h"
#include "texture_set.h"

namespace onmesh::tools {

/// A map: some consecutive textures of the set, on the faces that carry them.
struct InputMap {
  std::string name;  ///< as -t or the glTF slot has it; empty if it is the only one
  std::size_t first = 0, count = 0;
  TextureSlot slot = TextureSlot::base_colour;
  /// With the materials and UVs of the map's slot; null: the mesh itself.
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  bool has_own_uvs = false;         ///< others than the mesh, or read differently
  std::vector<Index> tile_of_face;  ///< counted from the first of them
  Role role = Role::unknown;        ///< of its textures
  bool is_filtered = true;          ///< else it may be a guide, and stays as it is
  FilteredChannels filtered = {};   ///< what of its textures is filtered
};

/// A guide with all that it refers to.
struct InputGuide {
  Guide guide;
  std::vector<Image> images;
  std::shared_ptr<const TriangleMesh> mesh;  ///< with its UVs, if these are others
  bool is_off = false;                       ///< none: distance alone
};

/// Mesh, textures, masks and guides as read, and what is told in the end.
struct SurfaceInputs {
  std::string mesh_path;
  TriangleMesh mesh;
  TextureSet set;                          ///< of all maps, one after the other
  std::vector<InputMap> maps;              ///< at least one unless there are no textures
  std::vector<Image> images;               ///< per texture of the set
  std::vector<ColourSpaceChoice> spaces;   ///< of those
  std::vector<Image> masks, sample_masks;  ///< per texture, if they were given
  std::vector<InputGuide> guides;
  Wrap wrap = Wrap::repeat;
  std::vector<StageTime> stages;
  std::vector<std::string> warnings;

  /// What the library takes of a map. Refers to images and masks.
  SurfaceTextures textures(std::size_t map = 0) const;
  const TriangleMesh& mesh_of(const InputMap& map) const { return map.mesh ? *map.mesh : mesh; }
  /// Those of all maps.
  std::vector<const TriangleMesh*> meshes() const;
  /// The results of what is filtered as whole textures; channels that were left out, and maps that
  /// are not filtered, are as they were. An image that several maps share has them all.
  /// \param parts per filtered map and texture
  std::vector<Image> whole_images(std::vector<std::vector<Image>> parts) const;
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
