// How two textures differ.
#pragma once

#include "onmesh/atlas/texel_map.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// How much two images differ.
struct ImageDifference {
  double psnr = 0;        ///< dB, peak 1 (infinity when equal)
  double rms = 0;         ///< root mean square of the values' differences
  double max = 0;         ///< the largest of them
  Index worst_texel = 0;  ///< the first that has the maximum
  Index texels = 0;       ///< compared
};

/// Compare two images over all channels. Two NaN, or two equal infinities, are equal. The same
/// result for any number of threads.
/// \param map if given, only its covered texels are compared
/// \throw InputError if sizes or channel counts differ, or a value is not finite in one image only
ImageDifference difference(const Image& a, const Image& b, const TexelMap* map = nullptr);

}  // namespace onmesh
