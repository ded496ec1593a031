#include "tile_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <utility>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"

namespace onmesh::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUdim = "<UDIM>";
constexpr const char* kUvTile = "<UVTILE>";

std::string uv_tile(int udim) {
  char text[32];
  std::snprintf(text, sizeof text, "u%d_v%d", (udim - 1001) % 10 + 1, (udim - 1001) / 10 + 1);
  return text;
}

/// A name that goes into a path: no folders.
std::string file_part(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

fs::path TileName::path_of(int udim) const {
  return before + (is_uv ? uv_tile(udim) : std::to_string(udim)) + after;
}

std::optional<int> TileName::tile_of(const fs::path& path) const {
  const std::string text = path.string();
  if (text.size() <= before.size() + after.size() || text.rfind(before, 0) != 0 ||
      text.compare(text.size() - after.size(), after.size(), after) != 0)
    return std::nullopt;
  const std::string middle = text.substr(before.size(), text.size() - before.size() - after.size());
  int first = 0, second = 0, used = 0;
  if (is_uv) {
    if (std::sscanf(middle.c_str(), "u%2d_v%3d%n", &first, &second, &used) != 2 ||
        std::size_t(used) != middle.size() || first < 1 || first > 10 || second < 1)
      return std::nullopt;
    return 1000 + first + 10 * (second - 1);
  }
  if (std::sscanf(middle.c_str(), "%4d%n", &first, &used) != 1 || used != 4 || middle.size() != 4 ||
      first < 1001)
    return std::nullopt;
  return first;
}

std::optional<TileName> tile_name(const fs::path& path) {
  const std::string text = path.string();
  for (const bool is_uv : {false, true}) {
    const std::string placeholder = is_uv ? kUvTile : kUdim;
    const std::size_t at = text.find(placeholder);
    if (at == std::string::npos) continue;
    return TileName{text.substr(0, at), text.substr(at + placeholder.size()), is_uv, true};
  }
  const std::string stem = path.stem().string();
  if (stem.size() < 5 || std::string(".-_").find(stem[stem.size() - 5]) == std::string::npos)
    return std::nullopt;
  const std::string digits = stem.substr(stem.size() - 4);
  if (!std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); }) ||
      digits < "1001")
    return std::nullopt;
  const std::size_t at = text.size() - path.extension().string().size() - 4;
  return TileName{text.substr(0, at), text.substr(at + 4), false, false};
}

bool has_placeholder(const std::string& output) {
  for (const char* name : {kUdim, kUvTile, "{map}", "{stem}", "{material}", "{ext}"}) {
    if (output.find(name) != std::string::npos) return true;
  }
  return false;
}

bool names_several(const std::string& name) {
  std::error_code error;
  return has_placeholder(name) || name.back() == '/' || fs::is_directory(name, error);
}

fs::path fill_placeholders(const std::string& output, const fs::path& texture,
                           const std::string& material, int udim, const std::string& map) {
  const int tile = udim == 0 ? 1001 : udim;
  const std::string extension = texture.extension().string();
  const std::array<std::pair<const char*, std::string>, 6> values{
      {{kUdim, std::to_string(tile)},
       {kUvTile, uv_tile(tile)},
       {"{map}", map.empty() ? "texture" : file_part(map)},
       {"{stem}", texture.stem().string()},
       {"{material}", file_part(material)},
       {"{ext}", extension.empty() ? "" : extension.substr(1)}}};
  std::string name = output;
  for (const auto& [placeholder, value] : values) name = replace_all(name, placeholder, value);
  return name;
}

bool is_image_name(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  for (const char* known : {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp", ".tga",
                            ".bmp", ".ppm", ".pgm", ".pbm", ".pfm", ".sgi", ".rgb", ".hdr"}) {
    if (extension == known) return true;
  }
  return false;
}

std::string replace_all(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace onmesh::tools
