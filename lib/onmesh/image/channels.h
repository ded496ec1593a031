// Some of an image's channels apart from the others.
#pragma once

#include <string>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// The values of some channels as an image of its own, which comes from no file and has no alpha.
/// \param channels numbers of the image's channels, in the order of the result's
Image take_channels(const Image& image, const std::vector<int>& channels);

/// Put the values of such an image back; the other channels stay as they are.
/// \param channels of the image, for the first channels of the part
/// \pre part is as large as image and has at least as many channels as are named
void put_channels(const Image& part, const std::vector<int>& channels, Image& image);

}  // namespace onmesh
