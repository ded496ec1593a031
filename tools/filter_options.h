// The options of onmesh filter as the library takes them.
#pragma once

#include <vector>

#include "arguments.h"
#include "onmesh/filter/map_set.h"
#include "onmesh/filter/options.h"
#include "surface_inputs.h"

namespace onmesh::tools {

/// What the arguments of filter say, but for guides.
/// \pre --preset was applied
/// \throw UsageError, OptionError
FilterOptions filter_options(const Arguments& arguments);

/// The maps as the library takes them. Refers to the inputs.
std::vector<SurfaceMap> library_maps(const SurfaceInputs& inputs);

/// The options with the guides that were read. They refer to the inputs.
FilterOptions with_guides(FilterOptions options, const SurfaceInputs& inputs);

}  // namespace onmesh::tools
