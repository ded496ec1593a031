// Looking a texture up at UVs.
#pragma once

#include "onmesh/base/wrap.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// Bilinear look-up at a UV: texel (i, j) has its centre at u = (i + .5) / W, v = 1 - (j + .5) / H.
///
/// A texel of weight 0 does not count, so that a value that is not finite spreads no further than
/// bilinear weights do.
/// \param out receives image.channels values
/// \param wrap how the image goes on beyond its border: a texel there is the one of the image that
///   its period shows, turned over or not, or the border's
/// \pre the image is not empty, the UV is finite
void bilinear(const Image& image, const WrapModes& wrap, const Vec2& uv, float* out);

}  // namespace onmesh
