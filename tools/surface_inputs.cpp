#include "surface_inputs.h"

#include <algorithm>
#include <cmath>

#include "command.h"
#include "guides.h"
#include "interruption.h"
#include "map_files.h"
#include "messages.h"
#include "onmesh/base/process_memory.h"
#include "onmesh/image/channels.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "presets.h"
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
std::vector<bool> are_opaque(const TriangleMesh& mesh, const InputMap& map) {
  std::vector<bool> opaque(map.count, true);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (map.tile_of_face[f] == kNone) continue;
    const Index material = mesh.face_materials[f];
    if (material == kNone || !mesh.materials[material].is_opaque)
      opaque[map.tile_of_face[f]] = false;
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
                              const std::vector<InputMap>& maps, const TextureSet& set,
                              std::vector<std::string>& warnings) {
  std::vector<Image> masks;
  if (!arguments.has(option)) return masks;
  const std::string name = arguments.text(option);
  const bool has_one =
      std::all_of(maps.begin(), maps.end(), [](const InputMap& map) { return map.count == 1; });
  if (!has_one && !has_placeholder(name)) {
    throw UsageError(dashed(option) + ": " + name + ": there are " +
                     std::to_string(set.textures.size()) +
                     " textures; name a mask for each, with <UDIM>, {stem} or {material}");
  }
  for (const SetTexture& texture : set.textures) {
    masks.emplace_back();
    if (only_written && !texture.is_written) continue;
    const auto path =
        fill_placeholders(name, texture.path, texture.material, texture.udim, texture.map);
    masks.back() = read_mask(path.string(), option, warnings);
  }
  return masks;
}

/// Alpha was asked for by name: what materials say of it does not count.
bool needs_alpha(const Arguments& arguments) {
  return (arguments.has("alpha") && arguments.flag("alpha")) ||
         (arguments.has("missing") && arguments.text("missing") == "alpha");
}

/// A map's images, and what their codes mean.
void read_images(const Arguments& arguments, bool has_slot, InputMap& map, SurfaceInputs& inputs) {
  ColourSpaceRequest spaces = colour_space_request(arguments, map.slot, has_slot);
  const Preset* const preset = preset_of(arguments);
  std::vector<std::string> names;
  for (std::size_t i = map.first; i < map.first + map.count; ++i) {
    const SetTexture& texture = inputs.set.textures[i];
    const auto same =
        std::find_if(inputs.set.textures.begin(), inputs.set.textures.begin() + std::ptrdiff_t(i),
                     [&](const SetTexture& other) { return other.path == texture.path; });
    const auto number = std::size_t(same - inputs.set.textures.begin());
    if (number < i) {
      inputs.images.push_back(inputs.images[number]);
    } else {
      inputs.images.push_back(read_texture(texture, inputs.warnings));
      refuse_image_bombs(inputs.set, inputs.images);
    }
    Image& image = inputs.images.back();
    spaces.role = texture.role;
    if (spaces.role == Role::unknown && preset != nullptr && preset->is_data)
      spaces.role = Role::data;
    inputs.spaces.push_back(choose_colour_space(image, spaces));
    if (inputs.spaces.back().has_no_alpha) image.alpha_channel = -1;
    names.push_back(texture.path.string());
    check_interrupted();
  }
  ChannelRequest request;
  request.slot = map.slot;
  if (arguments.has("layer")) request.layer = arguments.text("layer");
  if (has_slot && !needs_alpha(arguments)) request.opaque = are_opaque(inputs.mesh_of(map), map);
  const auto begin = inputs.images.begin() + std::ptrdiff_t(map.first);
  map.filtered = choose_channels(request, {begin, inputs.images.end()}, names, inputs.warnings);
}

/// The images of glTF materials for a slot, or what -t says of one map.
struct MapRequest : MapFiles {
  TextureSlot slot = TextureSlot::base_colour;
};

constexpr std::pair<TextureSlot, const char*> kSlots[] = {
    {TextureSlot::base_colour, "baseColor"},
    {TextureSlot::occlusion, "occlusion"},
    {TextureSlot::emissive, "emissive"},
    {TextureSlot::metallic_roughness, "metallicRoughness"},
    {TextureSlot::normal, "normal"}};

std::vector<MapRequest> requested_maps(const Arguments& arguments) {
  const bool all_slots = arguments.text("slot") == "all";
  if (arguments.has("texture")) {
    if (all_slots) throw UsageError("--slot all: the mesh's own textures, so not with -t");
    std::vector<MapRequest> maps;
    for (MapFiles& files : maps_of_files(arguments.texts("texture")))
      maps.push_back({std::move(files)});
    return maps;
  }
  if (!all_slots) return {{{}, slot_of(arguments)}};
  std::vector<MapRequest> maps;
  for (const auto& [slot, name] : kSlots) maps.push_back({{name, {}}, slot});
  return maps;
}

/// Also how textures are read beyond [0,1].
bool have_same_uvs(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same_wrap = [](const Material& x, const Material& y) {
    const WrapModes one = x.wrap.value_or(WrapModes()), other = y.wrap.value_or(WrapModes());
    return x.wrap.has_value() == y.wrap.has_value() && one.u == other.u && one.v == other.v;
  };
  return a.face_uvs == b.face_uvs && a.uvs == b.uvs &&
         std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                    same_wrap);
}

/// Choose the textures of a map and put them behind those that are there.
/// \return whether there are any
bool add_map(const Arguments& arguments, const MapRequest& wanted, const TextureRequest& request,
             SurfaceInputs& inputs) {
  InputMap map;
  map.name = wanted.name;
  map.slot = wanted.slot;
  const bool is_of_slots = arguments.text("slot") == "all";
  if (is_of_slots && wanted.slot != TextureSlot::base_colour) {
    ReadReport unused;
    auto mesh = std::make_shared<TriangleMesh>(
        read_mesh_file(inputs.mesh_path, arguments, unused, wanted.slot));
    map.mesh = std::move(mesh);
  }
  const TriangleMesh& mesh = inputs.mesh_of(map);
  TextureSet set = explained_by(inputs.warnings, [&] {
    return naming(inputs.mesh_path, [&] {
      const bool follows = !inputs.maps.empty() && wanted.files.size() == 1 &&
                           inputs.maps[0].count == 1 && !has_placeholder(wanted.files[0]);
      return follows ? textures_like(inputs.maps[0].tile_of_face, wanted.files[0])
                     : choose_textures(mesh, request);
    });
  });
  if (set.textures.empty()) return false;
  map.first = inputs.set.textures.size();
  map.count = set.textures.size();
  map.tile_of_face = set.tile_of_face;
  map.role = set.textures[0].role;
  map.is_filtered = map.slot != TextureSlot::normal && !is_normal(map.role);
  map.has_own_uvs = map.mesh && !have_same_uvs(*map.mesh, inputs.mesh);
  for (SetTexture& texture : set.textures) {
    texture.map = map.name;
    texture.is_written &= map.is_filtered;
    // An image of several maps is written once.
    for (const SetTexture& other : inputs.set.textures)
      texture.is_written &= !(other.path == texture.path && other.is_written);
  }
  if (inputs.maps.empty()) {
    inputs.set = std::move(set);
  } else {
    append(std::move(set), inputs.set);
  }
  inputs.maps.push_back(std::move(map));
  return true;
}

/// Null if there is none.
const Image* mask_of(const std::vector<Image>& masks, std::size_t texture) {
  return masks.empty() || masks[texture].pixels.empty() ? nullptr : &masks[texture];
}

}  // namespace

SurfaceTextures SurfaceInputs::textures(std::size_t number) const {
  const InputMap& map = maps[number];
  SurfaceTextures textures;
  textures.tile_of_face = map.tile_of_face;
  for (std::size_t i = map.first; i < map.first + map.count; ++i) {
    const SetTexture& file = set.textures[i];
    const std::vector<Image>& parts = map.filtered.parts;
    const Image* const image = parts.empty() ? &images[i] : &parts[i - map.first];
    TextureTile tile{image, wrap, file.column(), file.row(), file.path.string()};
    tile.space = spaces[i].space;
    tile.premultiplied = is_premultiplied(images[i]) && image->alpha_channel >= 0;
    tile.mask = mask_of(masks, i);
    tile.sample_mask = mask_of(sample_masks, i);
    textures.tiles.push_back(tile);
  }
  const Image& first = *textures.tiles[0].image;
  textures.maps = {
      {map.name, int(first.range_channels().size()), spaces[map.first].name == "data"}};
  return textures;
}

std::vector<const TriangleMesh*> SurfaceInputs::meshes() const {
  std::vector<const TriangleMesh*> all;
  for (const InputMap& map : maps) all.push_back(&mesh_of(map));
  return all;
}

std::vector<Image> SurfaceInputs::whole_images(std::vector<std::vector<Image>> parts) const {
  std::vector<Image> whole = images;
  std::size_t next = 0;
  for (const InputMap& map : maps) {
    if (!map.is_filtered) continue;
    std::vector<Image>& own = parts[next++];
    for (std::size_t i = 0; i < map.count; ++i) {
      const std::filesystem::path& path = set.textures[map.first + i].path;
      std::size_t first = 0;
      while (set.textures[first].path != path) ++first;
      if (!map.filtered.parts.empty()) {
        put_channels(own[i], map.filtered.channels[i], whole[first]);
      } else if (first == map.first + i) {
        whole[first] = std::move(own[i]);
      }
    }
  }
  return whole;
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

namespace {

/// Normal maps stay; those that do not even guide were meant to be filtered.
void refuse_normals(SurfaceInputs& inputs) {
  for (std::size_t m = 0; m < inputs.maps.size(); ++m) {
    const InputMap& map = inputs.maps[m];
    if (map.is_filtered) continue;
    const bool guides = std::any_of(
        inputs.guides.begin(), inputs.guides.end(),
        [&](const InputGuide& g) { return !map.name.empty() && g.guide.name == map.name; });
    const std::string name = inputs.set.textures[map.first].path.string();
    if (map.slot != TextureSlot::normal && !guides) {
      throw UsageError("--texture: " + name +
                       ": normal maps are not filtered yet: the mean of "
                       "their codes is no normal; it may be a guide, see --guide");
    }
    inputs.warnings.push_back(name + ": is a normal map and stays as it is");
  }
}

}  // namespace

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
  const bool of_slots = arguments.text("slot") == "all";
  // A glTF file with nothing to filter is written as it is, unless a slot was asked for.
  request.may_be_none =
      of_slots || (arguments.has("output") && is_gltf_name(arguments.text("output")) &&
                   !arguments.given("slot"));
  if (!arguments.has("texture")) request.confined_to = confining_folder(arguments);
  const std::vector<MapRequest> wanted = requested_maps(arguments);
  if (!of_slots && wanted[0].slot == TextureSlot::normal) {
    throw UsageError(
        "--slot: normal maps are not filtered yet: the mean of their codes is no normal");
  }
  ReadReport read;
  inputs.mesh = read_mesh_file(inputs.mesh_path, arguments, read);
  inputs.warnings = read.warnings;
  inputs.stages.push_back(stage("read mesh", watch));
  check_interrupted();
  const bool has_slot = is_gltf_name(inputs.mesh_path) && !arguments.has("texture");
  for (const MapRequest& one : wanted) {
    request.files = one.files;
    if (add_map(arguments, one, request, inputs))
      read_images(arguments, has_slot, inputs.maps.back(), inputs);
  }
  inputs.warnings.insert(inputs.warnings.end(), inputs.set.warnings.begin(),
                         inputs.set.warnings.end());
  if (inputs.maps.empty()) inputs.set.tile_of_face.assign(inputs.mesh.faces.size(), kNone);
  inputs.masks = read_masks(arguments, "mask", true, inputs.maps, inputs.set, inputs.warnings);
  inputs.sample_masks =
      read_masks(arguments, "mask-samples", false, inputs.maps, inputs.set, inputs.warnings);
  if (arguments.has("guide")) read_guides(arguments, inputs);
  refuse_normals(inputs);
  inputs.stages.push_back(stage("read texture", watch));
  return inputs;
}

}  // namespace onmesh::tools
