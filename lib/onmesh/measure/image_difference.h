// How two textures differ, and how visible a texture's seams are.
#pragma once

#include <optional>

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

struct ImageDifference {
  double psnr = 0;  ///< dB, peak 1 (infinity when equal)
  double rms = 0, max = 0;
  Index worst_texel = 0;  ///< the first that has the maximum
  Index texels = 0;       ///< compared
};

/// Over all channels; only covered texels if a map is given. Two NaN, or two equal infinities, are
/// equal. The same result for any number of threads.
/// \throw InputError if sizes or channel counts differ, or a value is not finite in one image only
ImageDifference difference(const Image& a, const Image& b, const TexelMap* map = nullptr);

struct SeamError {
  double rms = 0, max = 0;
  double length = 0;  ///< surface length of all seams, mesh units
  Index edges = 0;    ///< seam edges
};

/// Bilinear look-ups on both sides of every seam edge (an edge whose two faces carry the texture
/// with different UVs there), at about two points per texel along it: RMS (over the seams' length
/// and all channels) and maximum difference. Edges of more than two faces are left out.
SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map, const Image& image);

/// Bilinear look-up at a UV, texel centres at (i + .5) / W; `out` receives image.channels values.
void bilinear(const Image& image, Wrap wrap, const Vec2& uv, float* out);

}  // namespace onmesh
