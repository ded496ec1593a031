// Pictures of textures, and pictures beside each other.
#pragma once

#include <vector>

#include "onmesh/base/types.h"
#include "onmesh/image/image.h"

namespace onmesh {

/// What a texel looks like: its first three channels, or its first as grey, clamped to [0,1];
/// magenta if one of them is not a number. Alpha does not count.
/// \param texel its first channel of `channels`, at least one
Vec3 display_colour(const float* texel, int channels);

/// The texture itself, its longer side `size` pixels ([1, 16384]), with 3 channels. Texels show as
/// sharp rectangles where it is enlarged, as means where it is reduced. Every pixel is sampled at
/// least `supersampling` times per direction ([1, 8]).
/// \throw UsageError for arguments outside their domain
/// \throw InputError if the texture is empty
Image view_texture(const Image& texture, int size, int supersampling = 2);

/// Pictures beside each other on white, top-aligned, `gap` pixels apart.
/// \throw InputError unless all have the same number of channels
Image side_by_side(const std::vector<Image>& pictures, int gap = 8);

}  // namespace onmesh
