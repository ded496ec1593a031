// Light of the sky as a renderer bakes it, noise and all: data to clean.
#pragma once

#include <cstdint>

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::tools {

/// How much of an even sky each texel sees: the share of `rays` random directions, weighted by the
/// cosine, that go up (y) and meet nothing. Texels off the charts are 0.
/// The same for any number of threads.
/// \param rays for each texel, > 0
/// \return one channel
Image bake_sky(const TriangleMesh& mesh, int size, int rays, std::uint64_t seed);

}  // namespace onmesh::tools
