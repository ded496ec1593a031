// Where results go.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "texture_set.h"

namespace onmesh::tools {

/// Where the results of a set go.
struct OutputNames {
  std::vector<std::filesystem::path> paths;  ///< per texture; empty = it is not written
  std::filesystem::path folder;              ///< to be made if it is not there; empty = none
};

/// \param output a folder (which there is, or with a slash at the end), a pattern with `<UDIM>`,
///   `<UVTILE>`, `{stem}`, `{material}`, `{ext}`, or a plain name
/// \param extension of files in a folder, ".exr"; empty = as the texture's
/// \throw UsageError if two results would get one name, also if it differs in case only
OutputNames name_outputs(const TextureSet& set, const std::string& output,
                         const std::string& extension = {});

}  // namespace onmesh::tools
