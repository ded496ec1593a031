#include "presets.h"

#include <algorithm>

namespace onmesh::tools {

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list{
      {"lightmap",
       "noisy light maps",
       false,
       {{"sigma-spatial", "4tx"},
        {"range-space", "log"},
        {"despike", "4"},
        {"despike-to", "limit"},
        {"keep-mean", "true"},
        {"guide", "self:blur=1.5tx:2n"},
        {"guide", "self:median=1.5tx:2.5n"},
        {"guide", "self:1800n^3"},
        {"guide", "surface-normal:0.3"}}},
      {"ao",
       "noisy ambient occlusion and other numbers",
       true,
       {{"sigma-spatial", "4tx"},
        {"guide", "self:blur=3tx:0.4m"},
        {"guide", "self:20m^1.5"},
        {"guide", "surface-normal:0.35"}}},
      {"scan", "photo textures of scans", false, {{"sigma-spatial", "3tx"}, {"guide", "self:2n"}}},
      {"blur", "an even blur without seams", false, {{"kind", "gaussian"}}},
  };
  return list;
}

const Preset* apply_preset(Arguments& arguments) {
  if (!arguments.has("preset")) return nullptr;
  const std::string name = arguments.text("preset");
  const auto& list = presets();
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Preset& preset) { return name == preset.name; });
  if (found == list.end()) {
    std::string names;
    for (const Preset& preset : list) {
      if (!names.empty()) names += ", ";
      names += preset.name;
    }
    throw UsageError("--preset: '" + name + "' is not one of " + names);
  }
  // Whoever says what is compared, or that nothing is, wants no guides of the preset.
  const bool has_own_range = arguments.given("guide") || arguments.given("sigma-range") ||
                             (arguments.given("kind") && arguments.text("kind") == "gaussian");
  for (const PresetOption& option : found->options) {
    if (std::string(option.name) == "guide" && has_own_range) continue;
    arguments.set_default(option.name, option.value);
  }
  return &*found;
}

std::string text_of(const Preset& preset) {
  std::string text;
  for (const PresetOption& option : preset.options) {
    if (!text.empty()) text += ' ';
    text += dashed(option.name);
    if (option.value == std::string("true")) continue;
    text += ' ';
    text += option.value;
  }
  return text;
}

}  // namespace onmesh::tools
