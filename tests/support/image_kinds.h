// Small image files of all kinds that onmesh may be given.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace onmesh {

/// Write an image of some texels in every format, depth and compression that this build of
/// OpenImageIO can write. The extensions are the formats' own.
/// \return the files' names
std::vector<std::string> write_image_kinds(const std::filesystem::path& folder);

}  // namespace onmesh
