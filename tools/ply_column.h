// Reading one property of a PLY file's vertices.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace onmesh::tools {

/// The values of a vertex property, text or binary. Infinite ones and NaN are kept.
/// \throw FileError if the file cannot be read; InputError if it is malformed, ends early or has no
///   such property
std::vector<double> read_ply_column(const std::filesystem::path& path, const std::string& property);

}  // namespace onmesh::tools
