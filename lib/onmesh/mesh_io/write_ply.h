// Writing tables of points and faces as PLY, for stage files that other programs open.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// One vertex property of a PLY file: a name and a value per vertex.
struct PlyColumn {
  std::string name;            ///< one word
  std::vector<double> values;  ///< one per vertex
  bool integer = false;        ///< written as 32-bit int instead of double
};

/// Write binary little-endian PLY, atomically (temporary file beside the target, then rename). The
/// comment "TextureFile NAME" names a texture that readers show on the columns u and v.
/// \pre all columns have the same length, face indices are within it, integers fit 32 bits
/// \throw FileError
void write_ply(const std::filesystem::path& path, const std::vector<PlyColumn>& columns,
               const std::vector<std::array<Index, 3>>& faces = {},
               const std::vector<std::string>& comments = {});

}  // namespace onmesh
