// Where the texture is that a mesh file names.
#pragma once

#include <filesystem>
#include <string>

namespace onmesh {

/// The path of a texture as a mesh or material file writes it: relative to the file's `folder`,
/// with either kind of slash, perhaps in quotes, perhaps an absolute path of another machine (then
/// the file's bare name is tried).
/// \return the first that exists, else the plain reading; empty for an empty name
std::string find_texture(std::string name, const std::filesystem::path& folder);

}  // namespace onmesh
