#include "colour_spaces.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "command.h"
#include "onmesh/base/error.h"

namespace onmesh::tools {

namespace {

const std::pair<const char*, Role> kRoles[] = {
    {"data", Role::data},           {"colour", Role::colour},
    {"color", Role::colour},        {"normal-gl", Role::normal_gl},
    {"normal-dx", Role::normal_dx}, {"object-normal", Role::object_normal}};

bool is_file(const std::string& name) {
  std::error_code none;
  return std::filesystem::exists(name, none);
}

}  // namespace

NamedTexture split_role(const std::string& text, const char* option) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0 || is_file(text)) return {text, Role::unknown};
  const std::string role = text.substr(at + 1);
  const bool is_word = !role.empty() && std::all_of(role.begin(), role.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || c == '-';
  });
  if (!is_word) return {text, Role::unknown};
  for (const auto& [name, known] : kRoles)
    if (role == name) return {text.substr(0, at), known};
  throw UsageError(dashed(option) + ": " + text + ": unknown role '@" + role +
                   "'; there are @data (numbers, averaged as they are), @colour, @normal-gl, "
                   "@normal-dx and @object-normal");
}

NamedTexture split_texture(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (is_file(text) || equals == std::string::npos || equals == 0 || text.find('/') < equals)
    return split_role(text);
  NamedTexture texture = split_role(text.substr(equals + 1));
  texture.map = text.substr(0, equals);
  return texture;
}

bool is_normal(Role role) {
  return role == Role::normal_gl || role == Role::normal_dx || role == Role::object_normal;
}

void add_colour_space_options(boost::program_options::options_description& options) {
  auto add = options.add_options();
  add("colorspace", text(),
      "what the codes of all textures mean as light: sRGB, Rec709, GammaX (as Gamma2.2), ACEScg, "
      "linear, "
      "raw, or a colour space of $OCIO (default: by role, glTF slot, the file's tag; else integers "
      "of three channels or more are sRGB)");
  add("raw", flag(), "average codes as they are, the same as --colorspace raw");
}

void add_range_space_option(boost::program_options::options_description& options) {
  options.add_options()(
      "range-space", text("code"),
      "bilateral: what --sigma-range compares: code (as the file has it), linear (light), log (for "
      "high dynamic range: scaled light gives the same) or oklab (as colours look)");
}

ColourSpaceRequest colour_space_request_of_slot(TextureSlot slot, bool has_slot) {
  ColourSpaceRequest request;
  const bool is_colour = slot == TextureSlot::base_colour || slot == TextureSlot::emissive;
  request.slot_is_colour = has_slot && is_colour;
  request.slot_is_data = has_slot && !is_colour;
  return request;
}

ColourSpaceRequest colour_space_request(const Arguments& arguments, TextureSlot slot,
                                        bool has_slot) {
  ColourSpaceRequest request = colour_space_request_of_slot(slot, has_slot);
  if (arguments.has("colorspace")) request.name = arguments.text("colorspace");
  if (arguments.flag("raw")) {
    if (!request.name.empty() && request.name != "raw")
      throw UsageError("--raw: excludes --colorspace " + request.name);
    request.name = "raw";
  }
  return request;
}

RangeSpace range_space_of(const Arguments& arguments) {
  return arguments.choice<RangeSpace>("range-space", {{"code", RangeSpace::code},
                                                      {"linear", RangeSpace::linear},
                                                      {"log", RangeSpace::log},
                                                      {"oklab", RangeSpace::oklab}});
}

}  // namespace onmesh::tools
