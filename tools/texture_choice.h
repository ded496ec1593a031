// Which texture is meant, and which faces of the mesh carry it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::tools {

struct TextureChoice {
  std::filesystem::path path;
  std::vector<bool> faces;  ///< empty = all faces with UVs
  std::string reason;       ///< for the report: how texture and faces were found
};

/// Without `texture`, the one that the mesh's materials name; with it, the faces whose material
/// names the same file (or a file of the same name), else those of the only textured material, else
/// all. `material` decides where that is not enough: a material's name, or "all" for all faces.
/// \throw UsageError that says what to give: -t or --material with the names there are
TextureChoice choose_texture(const TriangleMesh& mesh, const std::optional<std::string>& texture,
                             const std::optional<std::string>& material);

/// Calls work(), which chooses a texture; if there is none to choose, the error says what was odd
/// about the mesh: a material file may be missing.
template <class Work>
auto explained_by(const std::vector<std::string>& warnings, const Work& work) {
  try {
    return work();
  } catch (const UsageError& error) {
    std::string message = error.what();
    for (const std::string& warning : warnings) message += "; " + warning;
    throw UsageError(message);
  }
}

}  // namespace onmesh::tools
