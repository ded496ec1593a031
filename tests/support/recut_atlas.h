// Cutting an atlas anew without resampling: for tests that the atlas must not matter.
#pragma once

#include <cstdint>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

struct RecutAtlas {
  TriangleMesh mesh;  ///< same faces in the same order, new UVs
  Image image;        ///< same values on the surface; noise on every other texel
  std::vector<Index>
      new_texel;  ///< per texel of the old image; kNone where no chart has its centre
  Index charts = 0;
};

/// Cut the charts into smaller ones along random edges, move each by whole texels, rotate it by a
/// random multiple of 90 degrees and pack all into a new atlas, at least 4 texels apart. Texel
/// centres land on texel centres, values are copied. Only edges that run along a texel row or
/// column, between texels, are cut (a cut elsewhere would split texels or count a centre on both
/// sides).
/// \pre mesh is welded; no texel is claimed by two charts
/// \throw InputError if a face has no UVs or reaches beyond [0,1], or there are no faces
RecutAtlas recut_atlas(const TriangleMesh& mesh, const Image& image, std::uint64_t seed);

}  // namespace onmesh
