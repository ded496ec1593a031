// Textures with fewer texels, for a preview.
#pragma once

#include <vector>

#include "onmesh/image/colour_space.h"
#include "onmesh/image/image.h"

namespace onmesh::tools {

/// Texels of the longer side of a preview's textures, at most.
inline constexpr int kPreviewTexels = 512;

/// By which whole number the sides are divided; 1 = it is small enough.
int reduction_of(const Image& image);

/// Means over blocks of texels, of linear light and weighed by alpha. Only texels that charts cover
/// count where a block has any, so that no padding gets in. What is not finite is left out. Codes
/// of integer files are rounded, as they would be in a file of this size. \param space of the
/// codes; null = they are light \param is_premultiplied whether colours are multiplied with alpha
/// already \param covered per texel; empty = all count \param factor texels per side of a block; 1
/// gives the image itself
Image reduced_texture(const Image& image, const ColourSpace* space, bool is_premultiplied,
                      const std::vector<unsigned char>& covered, int factor);

}  // namespace onmesh::tools
