// Looking a texture up at UVs.
#pragma once

#include "onmesh/image/image.h"

namespace onmesh {

/// How UVs outside [0,1] are read.
enum class Wrap {
  repeat,  ///< the texture repeats in every tile
  clamp,   ///< the texture's border goes on
};

/// Bilinear look-up at a UV: texel (i, j) has its centre at u = (i + .5) / W, v = 1 - (j + .5) / H.
///
/// A texel of weight 0 does not count, so that a value that is not finite spreads no further than
/// bilinear weights do.
/// \param out receives image.channels values
/// \pre the image is not empty, the UV is finite
void bilinear(const Image& image, Wrap wrap, const Vec2& uv, float* out);

}  // namespace onmesh
