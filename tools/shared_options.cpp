#include "shared_options.h"

#include <string>

#include "command.h"
#include "onmesh/mesh_io/write_gltf.h"

namespace onmesh::tools {
namespace {

void require_gltf(const Arguments& arguments, const std::string& option) {
  const auto is_gltf = [&](const char* name) {
    return arguments.has(name) && is_gltf_name(arguments.text(name));
  };
  // The textures are the mesh's, or those of files that are compared.
  if (!arguments.given(option) || is_gltf("mesh") || is_gltf("a")) return;
  throw UsageError(dashed(option) + ": only for glTF, and " + arguments.text("mesh") +
                   " is another mesh");
}

}  // namespace

Wrap wrap_of(const Arguments& arguments) {
  if (!arguments.has("wrap")) return Wrap::repeat;
  return arguments.choice<Wrap>(
      "wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}, {"mirror", Wrap::mirror}});
}

ReadOptions read_options_of(const Arguments& arguments) {
  ReadOptions options;
  options.confine = arguments.flag("confine");
  if (arguments.has("slot")) options.slot = slot_of(arguments);
  if (arguments.has("uv-set")) options.uv_set = uv_set_of(arguments);
  return options;
}

std::optional<Length> bridge_of(const Arguments& arguments) {
  return arguments.text("bridge") == "0" ? std::nullopt : std::optional(arguments.length("bridge"));
}

std::optional<Length> weld_of(const Arguments& arguments) {
  if (!arguments.has("weld")) return std::nullopt;
  return parse_tolerance("weld", arguments.text("weld"));
}

DistanceMethod distance_of(const Arguments& arguments) {
  try {
    return distance_method(arguments.text("distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
}

TextureSlot slot_of(const Arguments& arguments) {
  require_gltf(arguments, "slot");
  // All of them begin with that one, for the commands that write textures.
  if (arguments.text("slot") == "all" && arguments.has("gutter")) return TextureSlot::base_colour;
  return arguments.choice<TextureSlot>("slot",
                                       {{"baseColor", TextureSlot::base_colour},
                                        {"occlusion", TextureSlot::occlusion},
                                        {"emissive", TextureSlot::emissive},
                                        {"metallicRoughness", TextureSlot::metallic_roughness},
                                        {"normal", TextureSlot::normal}});
}

std::optional<std::uint64_t> uv_set_of(const Arguments& arguments) {
  require_gltf(arguments, "uv-set");
  if (!arguments.has("uv-set")) return std::nullopt;
  return std::uint64_t(arguments.integer("uv-set", 0, 1000));
}

void add_gltf_options(boost::program_options::options_description& options) {
  auto add = options.add_options();
  add("slot", text("baseColor"),
      "glTF: which textures of the materials: baseColor, occlusion (R), emissive, "
      "metallicRoughness (G and B) or normal; other channels stay as they are. filter and fill "
      "take "
      "all of them, too: normal maps stay as they are then");
  add("uv-set", text(),
      "glTF: N of TEXCOORD_N for all faces, such as 1 for a light map given by -t (default: what "
      "each texture is for)");
}

std::optional<std::filesystem::path> confining_folder(const Arguments& arguments) {
  if (!arguments.flag("confine")) return std::nullopt;
  return std::filesystem::path(arguments.text("mesh")).parent_path();
}

void add_weld_option(boost::program_options::options_description& options) {
  options.add_options()(
      "weld", text(),
      "length in mesh units or percent: boundaries that are no farther apart are joined (default: "
      "by the precision of the file's coordinates; 0: only what is equal)");
}

void add_wrap_option(boost::program_options::options_description& options) {
  options.add_options()("wrap", text(),
                        "what UVs outside [0,1] mean: repeat, clamp or mirror (default: as the "
                        "materials say, else repeat)");
}

void add_confine_option(boost::program_options::options_description& options) {
  options.add_options()("confine", flag(),
                        "refuse files that the mesh names outside its own folder (default: read "
                        "them with a warning; absolute paths and URLs are never followed)");
}

}  // namespace onmesh::tools
