#include "onmesh/mesh_io/read_mtl.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace {

/// The file name behind the options of a `map_Kd` line; options that take up to three numbers end
/// at the first token that is none, but never take the line's last token.
std::string_view texture_name(std::string_view line) {
  static const std::unordered_map<std::string, int> arguments = {
      {"-blendu", 1}, {"-blendv", 1},     {"-boost", 1},   {"-bm", 1}, {"-cc", 1},
      {"-clamp", 1},  {"-colorspace", 1}, {"-imfchan", 1}, {"-mm", 2}, {"-texres", 1},
      {"-type", 1},   {"-o", 3},          {"-s", 3},       {"-t", 3}};
  const auto split = [](std::string_view text) {
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::size_t next = std::min(text.find_first_not_of(" \t", end), text.size());
    return std::pair{text.substr(0, end), text.substr(next)};
  };
  while (line.starts_with('-')) {
    auto [option, rest] = split(line);
    const auto known = arguments.find(lower_case(option));
    if (known == arguments.end() || rest.empty()) break;  // a name that starts with a dash
    const bool optional = known->second == 3;
    for (int i = 0; i < known->second; ++i) {
      const auto [argument, behind] = split(rest);
      double value = 0;
      if (behind.empty() || (optional && !parse_number(argument, value))) break;
      rest = behind;
    }
    line = rest;
  }
  return line;
}

}  // namespace

std::vector<MaterialTexture> read_mtl(const std::string& content, const std::string& file) {
  TextScan scan(content, file, Syntax::comments_continuations);
  std::vector<MaterialTexture> textures;
  std::string material;  // empty: none has begun
  for (; !scan.at_end(); scan.next_line()) {
    const std::string keyword = lower_case(scan.token());
    if (keyword == "newmtl") {
      material = scan.rest_of_line();
    } else if (keyword == "map_kd" && !material.empty()) {
      textures.push_back({material, std::string(texture_name(scan.rest_of_line()))});
    }
  }
  return textures;
}

}  // namespace onmesh
