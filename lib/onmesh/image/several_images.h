// Files with more images than the one that is read (internal: included by the image sources only).
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

#include "onmesh/image/content_format.h"

namespace onmesh {

/// Refuse files of which nobody can say which image is meant, and note copies in lower resolution,
/// which are not read.
/// \param input opened; at its first image afterwards
/// \param warnings receives what is not read, without the file's name
/// \throw InputError if there are several parts or pages, naming parts
void check_single_image(const ImagePlace& place, OIIO::ImageInput& input,
                        std::vector<std::string>& warnings);

}  // namespace onmesh
