#include "onmesh/mesh_io/read_mtl.h"

#include <algorithm>
#include <array>
#include <utility>

#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"

namespace onmesh {
namespace {

/// An option of a texture map.
struct MapOption {
  std::string_view name;
  int arguments;
  bool optional;  ///< up to so many numbers, else exactly so many words
  /// Words that change nothing; empty: whatever follows changes something.
  std::array<std::string_view, 2> neutral;
};

constexpr std::array<MapOption, 14> kMapOptions = {{{"-blendu", 1, false, {"on"}},
                                                    {"-blendv", 1, false, {"on"}},
                                                    {"-boost", 1, false, {"0"}},
                                                    {"-bm", 1, false, {"1"}},
                                                    {"-cc", 1, false, {"off"}},
                                                    {"-clamp", 1, false, {"on", "off"}},
                                                    {"-colorspace", 1, false, {"srgb"}},
                                                    {"-imfchan", 1, false, {}},
                                                    {"-mm", 2, false, {"0", "1"}},
                                                    {"-texres", 1, false, {}},
                                                    {"-type", 1, false, {}},
                                                    {"-o", 3, true, {}},
                                                    {"-s", 3, true, {}},
                                                    {"-t", 3, true, {"0"}}}};

/// A word and what follows it.
std::pair<std::string_view, std::string_view> split_word(std::string_view text) {
  const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::size_t next = std::min(text.find_first_not_of(" \t", end), text.size());
  return {text.substr(0, end), text.substr(next)};
}

/// Whether words of a file mean the same: as numbers if they are.
bool means(std::string_view word, std::string_view meant) {
  double value = 0, other = 0;
  if (parse_number(word, value) && parse_number(meant, other)) return value == other;
  return lower_case(word) == meant;
}

/// The option changes nothing.
bool is_neutral(const MapOption& option, const std::vector<std::string_view>& words) {
  if (option.name == "-mm") {
    return words.size() == 2 && means(words[0], "0") && means(words[1], "1");
  }
  return !words.empty() && std::all_of(words.begin(), words.end(), [&](std::string_view word) {
    return std::any_of(option.neutral.begin(), option.neutral.end(), [&](std::string_view meant) {
      return !meant.empty() && means(word, meant);
    });
  });
}

/// Take what the option says over into the texture.
void apply(const MapOption& option, const std::vector<std::string_view>& words,
           MaterialTexture& texture) {
  if (option.name == "-s" || option.name == "-o") {
    Vec2 value = option.name == "-s" ? Vec2::Ones() : Vec2::Zero();
    for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 2); ++i) {
      parse_number(words[i], value[static_cast<int>(i)]);
    }
    (option.name == "-s" ? texture.scale : texture.offset) = value;
  } else if (!is_neutral(option, words)) {
    std::string text(option.name);
    for (const std::string_view word : words) (text += ' ') += quote(word);
    texture.ignored.push_back(text);
  } else if (option.name == "-clamp") {
    texture.wrap = means(words[0], "on") ? Wrap::clamp : Wrap::repeat;
  }
}

/// What a `map_Kd` line says: options, then the name. Options that take up to three numbers end at
/// the first token that is none, but never take the line's last token.
MaterialTexture parse_texture(std::string_view line) {
  MaterialTexture texture;
  while (line.starts_with('-')) {
    auto [name, rest] = split_word(line);
    const std::string wanted = lower_case(name);
    const auto* const option = std::find_if(kMapOptions.begin(), kMapOptions.end(),
                                            [&](const MapOption& o) { return o.name == wanted; });
    if (option == kMapOptions.end() || rest.empty()) break;  // a name that starts with a dash
    std::vector<std::string_view> words;
    for (int i = 0; i < option->arguments; ++i) {
      const auto [argument, behind] = split_word(rest);
      double value = 0;
      if (behind.empty() || (option->optional && !parse_number(argument, value))) break;
      words.push_back(argument);
      rest = behind;
    }
    apply(*option, words, texture);
    line = rest;
  }
  texture.texture = line;
  return texture;
}

/// A texture of another property than colour.
bool is_other_map(const std::string& keyword) {
  return keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" ||
         keyword == "decal" || keyword == "refl" || keyword == "norm";
}

}  // namespace

MaterialFile read_mtl(const std::string& content, const std::string& file) {
  TextScan scan(content, file, Syntax::comments_continuations);
  MaterialFile result;
  std::string material;                        // empty: none has begun
  std::map<std::string, std::string> written;  // keywords by their lower case
  for (; !scan.at_end(); scan.next_line()) {
    const std::string_view token = scan.token();
    const std::string keyword = lower_case(token);
    if (keyword == "newmtl") {
      material = scan.rest_of_line();
      if (!material.empty()) result.materials.push_back(material);
    } else if (keyword == "map_kd" && !material.empty()) {
      result.textures.push_back(parse_texture(scan.rest_of_line()));
      result.textures.back().material = material;
    } else if (keyword == "map_kd") {
      ++result.ignored["map_Kd before any newmtl"];
    } else if (is_other_map(keyword)) {
      // As it was first written; no file has so many kinds unless it is no material file.
      constexpr std::size_t kMostKinds = 32;
      std::string name = "other maps";
      if (written.size() < kMostKinds) {
        name = quote(token);
        name.erase(0, 1);
        name.pop_back();
      }
      ++result.ignored[written.try_emplace(keyword, name).first->second];
    }
  }
  return result;
}

std::string without_comment(std::string_view name) {
  for (std::size_t i = 1; i < name.size(); ++i) {
    if (name[i] != '#' || (name[i - 1] != ' ' && name[i - 1] != '\t')) continue;
    const std::size_t last = name.substr(0, i).find_last_not_of(" \t");
    if (last == std::string_view::npos) break;
    return std::string(name.substr(0, last + 1));
  }
  return std::string(name);
}

std::vector<std::string> readings_of(std::string_view name) {
  std::vector<std::string> readings{std::string(name)};
  if (std::string cut = without_comment(name); cut != readings[0]) readings.push_back(cut);
  return readings;
}

}  // namespace onmesh
