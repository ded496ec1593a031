#include "surface_inputs.h"

#include <algorithm>
#include <cmath>

#include "atlas.h"
#include "command.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "shared_options.h"
#include "tile_names.h"

namespace onmesh::tools {
namespace {

/// "1001,1003"
std::vector<int> tiles_of(const Arguments& arguments) {
  std::vector<int> tiles;
  if (!arguments.has("only")) return tiles;
  const std::string list = arguments.text("only");
  const auto count = std::size_t(std::count(list.begin(), list.end(), ',')) + 1;
  for (const double number : arguments.numbers("only", count)) {
    if (number != std::floor(number) || number < 1001 || number > 9999) {
      throw UsageError("--only: " + list + ": UDIM tiles are 1001 to 9999");
    }
    tiles.push_back(int(number));
  }
  return tiles;
}

/// Per texture whether the materials of all its faces say that alpha means nothing.
std::vector<bool> are_opaque(const TriangleMesh& mesh, const TextureSet& set) {
  std::vector<bool> opaque(set.textures.size(), true);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (set.tile_of_face[f] == kNone) continue;
    const Index material = mesh.face_materials[f];
    if (material == kNone || !mesh.materials[material].is_opaque)
      opaque[set.tile_of_face[f]] = false;
  }
  return opaque;
}

Image read_mask(const std::string& path, const char* option, std::vector<std::string>& warnings) {
  Image mask = read_texture(path, warnings);
  if (mask.range_channels().empty())
    throw InputError(path + ": has no channel but alpha, so it is nothing for " + dashed(option));
  check_interrupted();
  return mask;
}

/// One per texture: the file of --mask or --mask-samples, or those that its placeholders stand for.
/// \param only_written whether textures that are context need none: theirs stay empty
std::vector<Image> read_masks(const Arguments& arguments, const char* option, bool only_written,
                              const TextureSet& set, std::vector<std::string>& warnings) {
  std::vector<Image> masks;
  if (!arguments.has(option)) return masks;
  const std::string name = arguments.text(option);
  if (set.textures.size() > 1 && !has_placeholder(name)) {
    throw UsageError(dashed(option) + ": " + name + ": there are " +
                     std::to_string(set.textures.size()) +
                     " textures; name a mask for each, with <UDIM>, {stem} or {material}");
  }
  for (const SetTexture& texture : set.textures) {
    masks.emplace_back();
    if (only_written && !texture.is_written) continue;
    const auto path = fill_placeholders(name, texture.path, texture.material, texture.udim);
    masks.back() = read_mask(path.string(), option, warnings);
  }
  return masks;
}

/// Alpha was asked for by name: what materials say of it does not count.
bool needs_alpha(const Arguments& arguments) {
  return (arguments.has("alpha") && arguments.flag("alpha")) ||
         (arguments.has("missing") && arguments.text("missing") == "alpha");
}

/// The textures' images, and what their codes mean.
void read_images(const Arguments& arguments, TextureSlot slot, bool has_slot,
                 SurfaceInputs& inputs) {
  ColourSpaceRequest spaces = colour_space_request(arguments, slot, has_slot);
  std::vector<std::string> names;
  for (const SetTexture& texture : inputs.set.textures) {
    inputs.images.push_back(read_texture(texture, inputs.warnings));
    refuse_image_bombs(inputs.set, inputs.images);
    Image& image = inputs.images.back();
    spaces.role = texture.role;
    inputs.spaces.push_back(choose_colour_space(image, spaces));
    if (inputs.spaces.back().has_no_alpha) image.alpha_channel = -1;
    names.push_back(texture.path.string());
    check_interrupted();
  }
  ChannelRequest request;
  request.slot = slot;
  if (arguments.has("layer")) request.layer = arguments.text("layer");
  if (has_slot && !needs_alpha(arguments)) request.opaque = are_opaque(inputs.mesh, inputs.set);
  inputs.filtered = choose_channels(request, inputs.images, names, inputs.warnings);
}

/// Null if there is none.
const Image* mask_of(const std::vector<Image>& masks, std::size_t texture) {
  return masks.empty() || masks[texture].pixels.empty() ? nullptr : &masks[texture];
}

}  // namespace

SurfaceTextures SurfaceInputs::textures() const {
  SurfaceTextures textures =
      surface_textures(set, filtered.parts.empty() ? images : filtered.parts, wrap);
  for (std::size_t i = 0; i < images.size(); ++i) {
    TextureTile& tile = textures.tiles[i];
    tile.space = spaces[i].space;
    tile.premultiplied = is_premultiplied(images[i]) && tile.image->alpha_channel >= 0;
    tile.mask = mask_of(masks, i);
    tile.sample_mask = mask_of(sample_masks, i);
  }
  return textures;
}

void add_surface_options(boost::program_options::options_description& options) {
  auto add = options.add_options();
  add("texture,t", texts(),
      "a texture, also with <UDIM>, <UVTILE> or {material} in its name; may be given several times "
      "(default: those that the mesh's materials name)");
  add("material", text(),
      "write the texture of this material only, the others are context; with one -t the faces that "
      "carry it, 'all' = all faces");
  add("layer", text(),
      "take another layer of the images' channels, as in diffuse.R (default: R G B or Y; all "
      "other channels stay as they are)");
  add("only", text(), "write these UDIM tiles only, the others are context, such as 1001,1003");
  add("mask-samples", text(),
      "an image of any size, also with <UDIM>, {stem} or {material} in its name: where it is 0 "
      "texels have no value and get one from around them, grey ones count less");
  add_colour_space_options(options);
  add_wrap_option(options);
  add_weld_option(options);
  add_gltf_options(options);
  add_confine_option(options);
}

std::string why_nothing(const SurfaceInputs& inputs, bool into_gltf) {
  constexpr const char* kAllStay = ": all images stay as they are";
  if (!into_gltf) return {};
  if (inputs.set.textures.empty()) {
    return inputs.mesh_path + ": no material has a base colour texture (see --slot)" + kAllStay;
  }
  for (Index f = 0; f < inputs.mesh.faces.size(); ++f) {
    const bool has_texels = inputs.set.tile_of_face[f] != kNone && inputs.mesh.has_uvs(f) &&
                            inputs.mesh.uv_area(f) != 0;
    if (has_texels) return {};
  }
  // They may all be spots in a palette.
  return inputs.mesh_path + ": the UVs of no face have any area" + kAllStay;
}

StageTime stage(const char* name, Stopwatch& watch) {
  return {name, watch.lap(), peak_memory_bytes()};
}

void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  for (const std::string& warning : more) warnings.push_back(in_flags(warning));
}

SurfaceInputs read_surface(const Arguments& arguments, Stopwatch& watch) {
  SurfaceInputs inputs;
  inputs.mesh_path = arguments.argument("mesh");
  inputs.wrap = wrap_of(arguments);
  TextureRequest request{{}, arguments.optional_text("material"), tiles_of(arguments)};
  // A glTF file with nothing to filter is written as it is, unless a slot was asked for.
  request.may_be_none =
      arguments.has("output") && is_gltf_name(arguments.text("output")) && !arguments.given("slot");
  if (arguments.has("texture")) {
    request.files = arguments.texts("texture");
  } else {
    request.confined_to = confining_folder(arguments);
  }
  const TextureSlot slot = slot_of(arguments);
  if (slot == TextureSlot::normal) {
    throw UsageError(
        "--slot: normal maps are not filtered yet: the mean of their codes is no normal");
  }
  ReadReport read;
  inputs.mesh = read_mesh_file(inputs.mesh_path, arguments, read);
  inputs.warnings = read.warnings;
  inputs.stages.push_back(stage("read mesh", watch));
  check_interrupted();
  inputs.set = explained_by(inputs.warnings, [&] {
    return naming(inputs.mesh_path, [&] { return choose_textures(inputs.mesh, request); });
  });
  inputs.warnings.insert(inputs.warnings.end(), inputs.set.warnings.begin(),
                         inputs.set.warnings.end());
  read_images(arguments, slot, is_gltf_name(inputs.mesh_path) && !arguments.has("texture"), inputs);
  inputs.masks = read_masks(arguments, "mask", true, inputs.set, inputs.warnings);
  inputs.sample_masks = read_masks(arguments, "mask-samples", false, inputs.set, inputs.warnings);
  inputs.stages.push_back(stage("read texture", watch));
  return inputs;
}

}  // namespace onmesh::tools
