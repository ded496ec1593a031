// How far filter() is from the filter's definition.
#pragma once

#include <cstddef>

#include "onmesh/filter/filter.h"
#include "support/oracle.h"

namespace onmesh {

/// Options of the filter with sigma in mesh units and sigma_range = 0.2.
FilterOptions options_in_mesh_units(FilterKind kind, double sigma,
                                    DistanceMethod method = DistanceMethod::automatic);

/// Filter, and compare `count` texels with the definition. What lengths in texels mean and how far
/// the default radius reaches is worked out here, not asked of the filter.
/// \param distances on `mesh` \param result receives the filtered texture
/// \pre the mesh is welded and clean; lengths are in mesh units or texels
DefinitionError error_of_filter(const TriangleMesh& mesh, const Image& texture,
                                const FilterOptions& options, std::size_t count,
                                const Distances& distances, FilterReport* report = nullptr,
                                Image* result = nullptr);

}  // namespace onmesh
