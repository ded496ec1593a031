// Values for texels without any, smooth over the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/texel_values.h"

namespace onmesh {

/// Give texels the values of the harmonic function over the surface: every one is the mean of what
/// is around it, as a soap film spans a frame. Nothing flows over the surface's border. It goes
/// over seams, and however large the hole is: the system of make_texel_graph() is solved from
/// coarse to fine (LaplaceSolver), to some 1e-4 of the known values' spread. \param missing texels
/// to be given values, ascending, all covered; the other covered ones are
///   known and must be finite
/// \param channels that get values
/// \pre mesh and map belong together
/// \return how many are left as they are: no known texel is connected with them
std::uint64_t harmonic_fill(const TriangleMesh& mesh, const TexelMap& map,
                            const std::vector<Index>& missing, const std::vector<int>& channels,
                            const TexelValues& values);

}  // namespace onmesh
