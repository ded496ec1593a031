#include "live_options.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../../guides.h"
#include "../../subcommands.h"

namespace onmesh::tools {
namespace {

constexpr std::size_t kMostCharacters = 100;
constexpr std::size_t kMostGuides = 8;

/// What a page may set, by its name and that of the option.
constexpr std::pair<const char*, const char*> kOptions[] = {
    {"preset", "preset"},
    {"kind", "kind"},
    {"sigma_spatial", "sigma-spatial"},
    {"sigma_range", "sigma-range"},
    {"range_space", "range-space"},
    {"radius", "radius"},
    {"strength", "strength"},
    {"distance", "distance"},
    {"samples", "samples"},
    {"spacing", "spacing"},
};

std::string text_of(const std::string& name, const nlohmann::json& value) {
  if (!value.is_string()) throw UsageError(name + ": is no text");
  std::string text = value.get<std::string>();
  if (text.empty() || text.size() > kMostCharacters)
    throw UsageError(name + ": has " + std::to_string(text.size()) + " characters");
  return text;
}

/// Guides of a page are of the surface and of the values: no files.
std::string guide_of(const nlohmann::json& value) {
  std::string text = text_of("guides", value);
  for (const std::string name : {"self", "surface-normal"}) {
    const bool is_it = text.compare(0, name.size(), name) == 0 && text[name.size()] == ':';
    if (is_it && parse_guide(text).name == name) return text;
  }
  throw UsageError("--guide: " + text + ": here guides are self and surface-normal");
}

void number(std::optional<Length>& length, double texel_size) {
  if (length && length->unit == Length::Unit::texel)
    length = Length{length->value * texel_size, Length::Unit::mesh};
}

void number(Length& length, double texel_size) {
  std::optional<Length> one = length;
  number(one, texel_size);
  length = *one;
}

void number(RangeWidth& width, const FullScale& scale) {
  if (width.unit == RangeWidth::Unit::feature) return;
  const double noise = scale.noise(width.unit);
  if (noise > 0) width = RangeWidth(width.value * std::pow(noise, width.power));
}

}  // namespace

std::vector<std::string> words_of(const nlohmann::json& options) {
  if (!options.is_object()) throw UsageError("options: are no object");
  std::vector<std::string> words;
  for (const auto& [name, value] : options.items()) {
    if (name == "guides") {
      if (!value.is_array() || value.size() > kMostGuides)
        throw UsageError("guides: are no list of up to " + std::to_string(kMostGuides));
      for (const nlohmann::json& guide : value) {
        words.emplace_back("--guide");
        words.push_back(guide_of(guide));
      }
      continue;
    }
    const auto known =
        std::find_if(std::begin(kOptions), std::end(kOptions),
                     [&, &key = name](const auto& option) { return key == option.first; });
    if (known == std::end(kOptions)) throw UsageError(name + ": is no option of this window");
    std::string word = dashed(known->second);
    word += '=';
    word += text_of(name, value);
    words.push_back(std::move(word));
  }
  return words;
}

Arguments filter_arguments(const std::vector<std::string>& words) {
  std::optional<Arguments> arguments = parse(filter_command(), words);
  if (!arguments) throw UsageError("--help: is no option of this window");
  return *std::move(arguments);
}

FilterOptions with_numbers(FilterOptions options, const FullScale& scale) {
  number(options.sigma_spatial, scale.texel_size);
  number(options.radius, scale.texel_size);
  number(options.bridge, scale.texel_size);
  number(options.node_spacing, scale.texel_size);
  number(options.spacing, scale.texel_size);
  const bool compares_codes = options.range_space == RangeSpace::code;
  if (compares_codes) number(options.sigma_range, scale);
  for (Guide& guide : options.guides) {
    if (guide.kind == Guide::Kind::surface_position) number(guide.length, scale.texel_size);
    number(guide.blur, scale.texel_size);
    number(guide.median, scale.texel_size);
    if (compares_codes && guide.kind == Guide::Kind::own && !guide.is_smoothed())
      number(guide.width, scale);
  }
  return options;
}

}  // namespace onmesh::tools
