// What options must be like, whatever the mesh.
#pragma once

#include <cstddef>

#include "onmesh/filter/options.h"

namespace onmesh {

/// \throw OptionError naming `option` unless the value is positive and finite
void require_positive(const char* option, double value);

/// Refuse options outside their domain, those that exclude each other, and those that the mode
/// chosen would ignore.
/// \param faces of the mesh as given
/// \throw OptionError naming the field of FilterOptions
void check_options(const FilterOptions& options, std::size_t faces);

}  // namespace onmesh
