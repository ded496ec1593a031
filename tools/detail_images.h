// What the filter took away, as images of their own.
#pragma once

#include <string>
#include <vector>

#include "onmesh/image/image.h"
#include "onmesh/image/image_io.h"
#include "output_names.h"

namespace onmesh::tools {

/// Where details go, as --detail-out says.
/// \param outputs of the results
/// \throw UsageError for a format that does not hold 32-bit float, or a name that is taken
OutputNames name_details(const TextureSet& set, const std::string& output,
                         const OutputNames& outputs, const std::string& mesh_path);

/// What a texture was minus what is written, in codes (integers run from 0 to 1), all channels. The
/// file written plus that gives the texture again: rounded to integers exactly, in floats within
/// the last place of the larger of both.
/// \param written a file's name, its extension chooses the format
Image detail_of(const Image& before, const Image& after, const std::filesystem::path& written);

}  // namespace onmesh::tools
