// How two textures differ, and how visible a texture's seams are.
#pragma once

#include <optional>

#include "onmesh/image.h"
#include "onmesh/texel_map.h"

namespace onmesh {

struct ImageDifference {
  double psnr = 0;      ///< dB, peak 1 (infinity when equal)
  double rms = 0, max = 0;
  Index worst_texel = 0;
  Index texels = 0;     ///< compared
};

/// Over all channels; only covered texels if a map is given.
/// \throw InputError if sizes or channel counts differ, or a value is not a number
ImageDifference difference(const Image& a, const Image& b, const TexelMap* map = nullptr);

struct SeamError {
  double rms = 0, max = 0;
  double length = 0;       ///< surface length of all seams, mesh units
  Index edges = 0;         ///< seam edges
};

/// Bilinear look-ups on both sides of every seam edge (an edge whose two faces have different UVs),
/// at about two points per texel along it: RMS and maximum difference over all channels.
SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map, const Image& image);

/// Bilinear look-up at a UV, texel centres at (i + .5) / W; `out` receives image.channels values.
void bilinear(const Image& image, Wrap wrap, const Vec2& uv, float* out);

}  // namespace onmesh
