// What the command line says about guides.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <optional>
#include <string>

#include "arguments.h"
#include "colour_spaces.h"
#include "surface_inputs.h"

namespace onmesh::tools {

/// What --guide says.
struct GuideRequest {
  std::string name;  ///< "self", "surface-normal", "surface-position", a map or a file
  Role role = Role::unknown;
  std::optional<std::uint64_t> uv_set;
  std::optional<Length> blur, median;
  std::string width;
};

/// Reads NAME[@ROLE][@uvN][:blur=LENGTH]:S; median may stand for blur.
/// \throw UsageError naming what is wrong
GuideRequest parse_guide(const std::string& text);

/// Whether a name is that of a guide that is no map.
bool is_reserved_guide(const std::string& name);

/// What codes of such images mean as a guide.
Guide::Meaning meaning_of(Role role);

/// Read what --guide names, into inputs.guides.
/// \pre maps are chosen and their images read
/// \throw UsageError, FileError, InputError naming guide or file
void read_guides(const Arguments& arguments, SurfaceInputs& inputs);

}  // namespace onmesh::tools
