// The edges of a patch.
#pragma once

#include <array>
#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh {

/// Number edges from 0. They are identified by the gluing where the patch knows it, else by their
/// nodes and lengths: that also joins edges of three or more faces.
/// \param count receives the number of edges
/// \return the number of edge k of every face
std::vector<std::array<Index, 3>> number_edges(const Patch& patch, Index& count);

}  // namespace onmesh
