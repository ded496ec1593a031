#include "presets.h"

namespace onmesh::tools {

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list{
      {"lightmap",
       "noisy light maps",
       false,
       {{"sigma-spatial", "4tx"},
        {"radius", "8tx"},
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
        {"radius", "8tx"},
        {"guide", "self:blur=2tx:0.6m"},
        {"guide", "self:9m^1.5"},
        {"guide", "surface-normal:0.35"}}},
      {"scan",
       "photo textures of scans",
       false,
       {{"sigma-spatial", "3tx"}, {"guide", "self:blur=1tx:1m"}, {"guide", "self:3m"}}},
      {"blur", "an even blur without seams", false, {{"kind", "gaussian"}}},
  };
  return list;
}

const Preset* preset_of(const Arguments& arguments) {
  if (!arguments.has("preset")) return nullptr;
  const std::string name = arguments.text("preset");
  std::string names;
  for (const Preset& preset : presets()) {
    if (name == preset.name) return &preset;
    if (!names.empty()) names += ", ";
    names += preset.name;
  }
  throw UsageError("--preset: '" + name + "' is not one of " + names);
}

const Preset* apply_preset(Arguments& arguments) {
  const Preset* const found = preset_of(arguments);
  if (found == nullptr) return nullptr;
  // Whoever says what is compared, or that nothing is, wants no guides of the preset.
  const bool has_own_range = arguments.given("guide") || arguments.given("sigma-range") ||
                             (arguments.given("kind") && arguments.text("kind") == "gaussian");
  for (const PresetOption& option : found->options) {
    if (std::string(option.name) == "guide" && has_own_range) continue;
    arguments.set_default(option.name, option.value);
  }
  return found;
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
