// Options for what people clean most often, under one name.
#pragma once

#include <string>
#include <vector>

#include "arguments.h"

namespace onmesh::tools {

/// An option that a preset gives another default.
struct PresetOption {
  const char* name;
  const char* value;
};

/// One of the values of --preset.
struct Preset {
  const char* name;
  const char* purpose;  ///< for --help
  bool is_data;         ///< its textures are numbers unless their role says otherwise
  std::vector<PresetOption> options;
};

const std::vector<Preset>& presets();

/// The value of --preset; null if none was asked for.
/// \throw UsageError if there is no such preset
const Preset* preset_of(const Arguments& arguments);

/// Give the options of --preset their defaults; options that were given stay.
/// \return the preset, null if none was asked for
/// \throw UsageError if there is no such preset
const Preset* apply_preset(Arguments& arguments);

/// "--kind bilateral --despike 2.5 ..."
std::string text_of(const Preset& preset);

}  // namespace onmesh::tools
