// Options that several subcommands take: what they are, and how they are read.
#pragma once

#include <optional>

#include "arguments.h"
#include "onmesh/distance/backend.h"
#include "onmesh/image/lookup.h"

namespace onmesh::tools {

/// The value of --wrap.
Wrap wrap_of(const Arguments& arguments);
/// The length that --bridge gives, nothing for none (0, the default).
std::optional<Length> bridge_of(const Arguments& arguments);
/// The value of --distance.
DistanceMethod distance_of(const Arguments& arguments);

}  // namespace onmesh::tools
