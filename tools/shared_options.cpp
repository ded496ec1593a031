#include "shared_options.h"

#include <string>

#include "command.h"

namespace onmesh::tools {

Wrap wrap_of(const Arguments& arguments) {
  return arguments.choice<Wrap>("wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}});
}

std::optional<Length> bridge_of(const Arguments& arguments) {
  return arguments.text("bridge") == "0" ? std::nullopt : std::optional(arguments.length("bridge"));
}

std::optional<Length> weld_of(const Arguments& arguments) {
  if (!arguments.has("weld")) return std::nullopt;
  if (arguments.text("weld") == "0") return Length{0, Length::Unit::mesh};
  const Length weld = arguments.length("weld");
  if (weld.unit == Length::Unit::texel)
    throw UsageError("--weld: is in mesh units or percent, not in texels");
  return weld;
}

DistanceMethod distance_of(const Arguments& arguments) {
  try {
    return distance_method(arguments.text("distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
}

void add_weld_option(boost::program_options::options_description& options) {
  options.add_options()(
      "weld", text(),
      "length in mesh units or percent: boundaries that are no farther apart are joined (default: "
      "by the precision of the file's coordinates; 0: only what is equal)");
}

}  // namespace onmesh::tools
