#include "output_names.h"

#include <map>

#include "onmesh/base/text.h"
#include "tile_names.h"

namespace onmesh::tools {

namespace fs = std::filesystem;

OutputNames name_outputs(const TextureSet& set, const std::string& output,
                         const std::string& extension) {
  OutputNames names;
  names.paths.resize(set.textures.size());
  std::error_code error;
  const bool is_folder = output.back() == '/' || fs::is_directory(output, error);
  const bool is_pattern = has_placeholder(output);
  if (is_folder) names.folder = fs::path(output).lexically_normal();
  if (!is_folder && is_pattern) names.folder = fs::path(output).parent_path();
  std::map<std::string, std::string> taken;
  for (std::size_t i = 0; i < set.textures.size(); ++i) {
    const SetTexture& texture = set.textures[i];
    if (!texture.is_written) continue;
    if (is_folder) {
      names.paths[i] = fs::path(output) / texture.path.filename();
      if (!extension.empty()) names.paths[i].replace_extension(extension);
    } else {
      names.paths[i] =
          fill_placeholders(output, texture.path, texture.material, texture.udim, texture.map);
    }
    const std::string key = lower_case(fs::absolute(names.paths[i]).lexically_normal().string());
    const auto [at, is_new] = taken.try_emplace(key, texture.path.string());
    if (!is_new) {
      throw UsageError(
          "--output: " + at->second + " and " + texture.path.string() +
          " would both be written to " + names.paths[i].string() +
          "; give a folder (out/) or a pattern with <UDIM>, {map}, {stem} or {material}");
    }
  }
  return names;
}

}  // namespace onmesh::tools
