// How two textures differ.
#pragma once

#include <vector>

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
/// \param counted per texel, 0 = it is not compared; empty = all are
/// \throw InputError if sizes or channel counts differ, or a value is not finite in one image only
ImageDifference difference(const Image& a, const Image& b,
                           const std::vector<unsigned char>& counted = {});

/// Which texels of a tile are covered, for difference().
std::vector<unsigned char> covered_texels(const TexelMap& map, Index tile = 0);

/// That of several pairs of images, all texels counted alike, however many channels they have. The
/// worst texel is that of the pair with the largest maximum, the first if several have it. \param
/// which receives the number of that pair \pre there are some
ImageDifference together(const std::vector<ImageDifference>& parts, std::size_t* which = nullptr);

}  // namespace onmesh
