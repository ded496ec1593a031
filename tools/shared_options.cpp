#include "shared_options.h"

#include <string>

#include "command.h"

namespace onmesh::tools {

Wrap wrap_of(const Arguments& arguments) {
  if (!arguments.has("wrap")) return Wrap::repeat;
  return arguments.choice<Wrap>(
      "wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}, {"mirror", Wrap::mirror}});
}

ReadOptions read_options_of(const Arguments& arguments) { return {arguments.flag("confine")}; }

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

std::optional<std::filesystem::path> confining_folder(const Arguments& arguments) {
  if (!arguments.flag("confine")) return std::nullopt;
  return std::filesystem::path(arguments.text("mesh")).parent_path();
}

void add_weld_option(boost::program_options::options_description& options) {
  options.add_options()(
      "weld", text(),
      "length in mesh units or percent: boundaries that are no farther apart are joined (default: "
      "by the precision of the file's coordinates; 0: only what is equal)");
}

void add_wrap_option(boost::program_options::options_description& options) {
  options.add_options()("wrap", text(),
                        "what UVs outside [0,1] mean: repeat, clamp or mirror (default: as the "
                        "materials say, else repeat)");
}

void add_confine_option(boost::program_options::options_description& options) {
  options.add_options()("confine", flag(),
                        "refuse files that the mesh names outside its own folder (default: read "
                        "them with a warning; absolute paths and URLs are never followed)");
}

}  // namespace onmesh::tools
