// What options must be like, whatever the mesh.
#pragma once

#include <cstddef>

#include "onmesh/filter/options.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// \throw OptionError naming `option` unless the value is positive and finite
void require_positive(const char* option, double value);

/// \throw OptionError naming `option` and the domain unless least <= value <= largest
/// \param of what the values are multiples of: " of the mesh's diagonal"; may be empty
void require_within(const char* option, double value, double least, double largest,
                    const char* of = "");

/// Refuse options outside their domain, those that exclude each other, and those that the mode
/// chosen would ignore.
/// \param faces of the mesh as given
/// \throw OptionError naming the field of FilterOptions
void check_options(const FilterOptions& options, std::size_t faces);

/// \throw InputError if the mesh's arrays do not fit together, or a position is not finite
void check_arrays(const TriangleMesh& mesh);

/// \param faces of the mesh as given
/// \throw InputError if an image's arrays do not fit together, it has no channel but alpha, or the
///   channels of the tiles differ
void check_textures(const SurfaceTextures& textures, std::size_t faces,
                    RangeSpace range_space = RangeSpace::code);

/// \pre check_textures() has passed
/// \throw InputError if the textures have no alpha
void check_alpha(const SurfaceTextures& textures);

}  // namespace onmesh
