#include "shared_options.h"

#include "onmesh/image/image_io.h"

#include <charconv>
#include <utility>

#include "command.h"
#include "messages.h"
#include "texture_choice.h"

namespace onmesh::tools {
namespace {

// "512x256"
void parse_resolution(const std::string& text, Atlas& atlas) {
  const char* const end = text.data() + text.size();
  const auto [cross, first] = std::from_chars(text.data(), end, atlas.width);
  if (first == std::errc() && cross != end && (*cross == 'x' || *cross == 'X')) {
    const auto [rest, second] = std::from_chars(cross + 1, end, atlas.height);
    const auto fits = [](int side) { return side >= 1 && side <= 32768; };
    if (second == std::errc() && rest == end && fits(atlas.width) && fits(atlas.height)) return;
  }
  throw UsageError("--resolution: '" + text + "' is not WIDTHxHEIGHT with sides of 1 to 32768");
}

}  // namespace

Wrap wrap_of(const Arguments& arguments) {
  return arguments.choice<Wrap>("wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}});
}

std::optional<Length> bridge_of(const Arguments& arguments) {
  return arguments.text("bridge") == "0" ? std::nullopt : std::optional(arguments.length("bridge"));
}

std::optional<Length> weld_of(const Arguments& arguments) {
  if (!arguments.has("weld")) return std::nullopt;
  if (arguments.text("weld") == "0") return Length{0, Length::Unit::mesh};
  const Length weld = arguments.length("weld");
  if (weld.unit == Length::Unit::texel)
    throw UsageError("--weld: is in mesh units or percent, not in texels");
  return weld;
}

DistanceMethod distance_of(const Arguments& arguments) {
  try {
    return distance_method(arguments.text("distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
}

void add_atlas_options(boost::program_options::options_description& options) {
  auto add = options.add_options();
  add("texture,t", text(),
      "a texture of the atlas (default: the one that the mesh's materials name)");
  add("resolution", text(), "size of the atlas instead of a texture, such as 1024x1024");
  add("material", text(), "only the faces of this material; all = every face with UVs");
  add("wrap", text("repeat"), "what UVs outside [0,1] mean: repeat or clamp");
}

void add_weld_option(boost::program_options::options_description& options) {
  options.add_options()(
      "weld", text(),
      "length in mesh units or percent: boundaries that are no farther apart are joined (default: "
      "by the precision of the file's coordinates; 0: only what is equal)");
}

bool has_atlas_option(const Arguments& arguments) {
  return arguments.has("texture") || arguments.has("resolution");
}

Atlas read_atlas(const Arguments& arguments, const TriangleMesh& mesh, const std::string& texture) {
  Atlas atlas;
  atlas.map.wrap = wrap_of(arguments);
  const auto material = arguments.optional_text("material");
  if (arguments.has("resolution")) {
    if (arguments.has(texture)) throw UsageError("-t and --resolution exclude each other");
    parse_resolution(arguments.text("resolution"), atlas);
    if (material) atlas.map.faces = choose_texture(mesh, "", material).faces;
    return atlas;
  }
  TextureChoice choice;
  try {
    choice = choose_texture(mesh, arguments.optional_text(texture), material);
  } catch (const UsageError& error) {
    if (arguments.has(texture)) throw;
    throw UsageError(std::string(error.what()) + ", or give --resolution");
  }
  atlas.texture = choice.path.string();
  atlas.map.faces = std::move(choice.faces);
  atlas.image = read_texture(atlas.texture);
  atlas.width = atlas.image.width;
  atlas.height = atlas.image.height;
  return atlas;
}

TexelMap covered_map(const InputMesh& input, const Atlas& atlas) {
  TexelMap map = naming(
      input, [&] { return make_texel_map(input.cleaned, atlas.width, atlas.height, atlas.map); });
  if (map.claims.empty()) throw InputError(input.path + ": no texel is covered; has the mesh UVs?");
  return map;
}

}  // namespace onmesh::tools
