// Layers of channels: an image's own, and those beside it that are no colours of it.
#pragma once

#include <string>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// The channels of a layer, by their numbers: R G B (A) or Y (A), else all that it has.
/// \param layer as in "diffuse" of the channel "diffuse.R", or a channel's whole name; empty = the
///   channels without a layer's name, or those of the only layer if there are none. An image of up
///   to four channels whose names say nothing has one layer with all of them.
/// \throw InputError if there is no such layer, or none without a name and several with one: with
///   the names that there are
std::vector<int> layer_channels(const Image& image, const std::string& layer = {});

}  // namespace onmesh
