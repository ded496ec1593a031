#include "guides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include "atlas.h"
#include "command.h"
#include "interruption.h"
#include "onmesh/base/error.h"
#include "onmesh/mesh_io/write_gltf.h"
#include "tile_names.h"

namespace onmesh::tools {
namespace {

UsageError bad_guide(const std::string& text, const std::string& why) {
  return UsageError("--guide: " + text + ": " + why);
}

/// The N of "...@uvN", which is taken away.
std::optional<std::uint64_t> take_uv_set(std::string& name) {
  const std::size_t at = name.rfind("@uv");
  std::error_code none;
  if (at == std::string::npos || std::filesystem::exists(name, none)) return std::nullopt;
  std::uint64_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + at + 3, end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  name.erase(at);
  return number;
}

/// The images of a guide's file, or files: of the textures of the first map, or by other UVs.
void read_files(const Arguments& arguments, const GuideRequest& wanted, const SurfaceInputs& inputs,
                std::vector<std::string>& warnings, InputGuide& guide) {
  TextureSet set;
  if (wanted.uv_set) {
    if (!is_gltf_name(inputs.mesh_path)) {
      throw bad_guide(wanted.name, "@uv" + std::to_string(*wanted.uv_set) +
                                       " is for glTF: other meshes have one set of UVs");
    }
    auto mesh = std::make_shared<TriangleMesh>(
        read_mesh_with_uvs(inputs.mesh_path, arguments, *wanted.uv_set));
    TextureRequest request;
    request.files = {wanted.name};
    if (wanted.name.find("{material}") == std::string::npos) request.material = "all";
    set = choose_textures(*mesh, request);
    guide.mesh = std::move(mesh);
  } else {
    const InputMap& map = inputs.maps[0];
    if (map.count > 1 && !has_placeholder(wanted.name)) {
      throw bad_guide(wanted.name, "there are " + std::to_string(map.count) +
                                       " textures; name a guide for each, with <UDIM>, {stem} or "
                                       "{material}");
    }
    set.tile_of_face = map.tile_of_face;
    for (std::size_t i = 0; i < map.count; ++i) {
      SetTexture texture = inputs.set.textures[map.first + i];
      texture.path =
          fill_placeholders(wanted.name, texture.path, texture.material, texture.udim, map.name);
      texture.content = nullptr;
      texture.place.clear();
      set.textures.push_back(texture);
    }
  }
  guide.guide.meaning = meaning_of(wanted.role);
  ColourSpaceRequest spaces;
  spaces.role = wanted.role;
  if (arguments.flag("raw")) spaces.name = "raw";
  std::vector<std::shared_ptr<const ColourSpace>> chosen;
  bool is_data = false;
  for (const SetTexture& texture : set.textures) {
    guide.images.push_back(read_texture(texture, warnings));
    Image& image = guide.images.back();
    const ColourSpaceChoice choice = choose_colour_space(image, spaces);
    if (choice.has_no_alpha) image.alpha_channel = -1;
    const auto channels = image.range_channels().size();
    if (channels == 0) throw InputError(texture.path.string() + ": has no channel but alpha");
    if (is_normal(wanted.role) && channels != 3) {
      throw InputError(texture.path.string() + ": has " + std::to_string(channels) +
                       " channels, and normals have three");
    }
    chosen.push_back(choice.space);
    is_data |= choice.name == "data";
    check_interrupted();
  }
  guide.guide.textures = surface_textures(set, guide.images, inputs.wrap);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    guide.guide.textures.tiles[i].space = chosen[i];
    guide.guide.textures.tiles[i].premultiplied =
        is_premultiplied(guide.images[i]) && guide.images[i].alpha_channel >= 0;
  }
  const int channels = int(guide.images[0].range_channels().size());
  guide.guide.textures.maps = {{wanted.name, channels, is_data}};
  guide.guide.mesh = guide.mesh.get();
}

}  // namespace

Guide::Meaning meaning_of(Role role) {
  switch (role) {
    case Role::normal_gl:
      return Guide::Meaning::normal_gl;
    case Role::normal_dx:
      return Guide::Meaning::normal_dx;
    case Role::object_normal:
      return Guide::Meaning::object_normal;
    default:
      return Guide::Meaning::values;
  }
}

bool is_reserved_guide(const std::string& name) {
  return name == "self" || name == "surface-normal" || name == "surface-position" || name == "none";
}

GuideRequest parse_guide(const std::string& text) {
  GuideRequest guide;
  if (text == "none") {
    guide.name = text;
    return guide;
  }
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size())
    throw bad_guide(text, "is not NAME:S, such as surface-normal:0.25, or none");
  guide.width = text.substr(colon + 1);
  std::string name = text.substr(0, colon);
  for (const auto& [key, length] :
       {std::pair(":blur=", &guide.blur), std::pair(":median=", &guide.median)}) {
    const std::size_t at = name.rfind(key);
    if (at == std::string::npos) continue;
    *length = parse_length("guide", name.substr(at + std::string_view(key).size()));
    name.erase(at);
  }
  guide.uv_set = take_uv_set(name);
  const NamedTexture named = split_role(name, "guide");
  guide.name = named.name;
  guide.role = named.role;
  if (!guide.uv_set) guide.uv_set = take_uv_set(guide.name);
  if (guide.name.empty()) throw bad_guide(text, "has no name");
  if (guide.width.rfind("blur=", 0) == 0 || guide.width.rfind("median=", 0) == 0)
    throw bad_guide(text, "has no width at its end");
  if (is_reserved_guide(guide.name) && (guide.role != Role::unknown || guide.uv_set))
    throw bad_guide(text, guide.name + " is no image: it has neither role nor UVs");
  return guide;
}

void read_guides(const Arguments& arguments, SurfaceInputs& inputs) {
  if (inputs.maps.empty()) return;
  const std::vector<std::string> texts = arguments.texts("guide");
  const auto filtered =
      std::count_if(inputs.maps.begin(), inputs.maps.end(), [](auto& m) { return m.is_filtered; });
  for (const std::string& text : texts) {
    const GuideRequest wanted = parse_guide(text);
    InputGuide& guide = inputs.guides.emplace_back();
    guide.guide.name = wanted.name;
    guide.guide.blur = wanted.blur;
    guide.guide.median = wanted.median;
    if (wanted.name == "none") {
      if (texts.size() > 1) throw bad_guide(text, "excludes other guides");
      guide.is_off = true;
      continue;
    }
    if (wanted.name == "surface-position") {
      guide.guide.kind = Guide::Kind::surface_position;
      guide.guide.length = parse_length("guide", wanted.width);
      continue;
    }
    guide.guide.width = parse_range_width("guide", wanted.width);
    if (wanted.name == "surface-normal") {
      guide.guide.kind = Guide::Kind::surface_normal;
      continue;
    }
    const auto map = std::find_if(inputs.maps.begin(), inputs.maps.end(),
                                  [&](const InputMap& m) { return m.name == wanted.name; });
    if (wanted.name == "self") {
      if (filtered > 1) {
        throw bad_guide(text, "there are several maps; name one of them as guide");
      }
      guide.guide.map = 0;
      while (!inputs.maps[std::size_t(guide.guide.map)].is_filtered) ++guide.guide.map;
    } else if (map != inputs.maps.end() && !map->name.empty()) {
      if (wanted.uv_set || wanted.role != Role::unknown)
        throw bad_guide(text, "a map of the set has its own role and UVs");
      guide.guide.map = int(map - inputs.maps.begin());
    } else {
      guide.guide.kind = Guide::Kind::images;
      std::error_code none;
      if (!has_placeholder(wanted.name) && !std::filesystem::exists(wanted.name, none)) {
        std::string maps;
        for (const InputMap& m : inputs.maps)
          if (!m.name.empty()) maps += ", " + m.name;
        throw bad_guide(text, "there is no guide or file '" + wanted.name +
                                  "'; there are self, surface-normal, surface-position" + maps +
                                  " and files");
      }
      read_files(arguments, wanted, inputs, inputs.warnings, guide);
    }
  }
}

}  // namespace onmesh::tools
