// The maps of a page from what filter reads and makes.
#pragma once

#include <vector>

#include "../surface_inputs.h"
#include "review.h"

namespace onmesh::tools {

/// As it is in the file: integers are rounded there.
void round_to_codes(Image& image);

/// Maps on the faces of the first one, with that one's tiles. Others are noted.
/// \param runs results per run and texture
void add_input_maps(const SurfaceInputs& inputs, std::vector<std::vector<Image>> runs,
                    Review& review);

}  // namespace onmesh::tools
