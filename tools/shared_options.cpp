#include "shared_options.h"

#include <string>

namespace onmesh::tools {
Wrap wrap_of(const Arguments& arguments) {
  return arguments.choice<Wrap>("wrap", {{"repeat", Wrap::repeat}, {"clamp", Wrap::clamp}});
}

std::optional<Length> bridge_of(const Arguments& arguments) {
  return arguments.text("bridge") == "0" ? std::nullopt : std::optional(arguments.length("bridge"));
}

DistanceMethod distance_of(const Arguments& arguments) {
  try {
    return distance_method(arguments.text("distance"));
  } catch (const UsageError& error) {
    throw UsageError(std::string("--distance: ") + error.what());
  }
}

}  // namespace onmesh::tools
