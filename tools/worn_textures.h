// The textures that a mesh wears, for people to see.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "onmesh/render/render.h"
#include "texture_set.h"

namespace onmesh::tools {

/// A mesh with the textures that it wears.
class WornTextures {
 public:
  /// \param mesh outlives this
  explicit WornTextures(const TriangleMesh& mesh) {
    set_.tile_of_face.assign(mesh.faces.size(), kNone);
  }

  void add(const TextureSet& set);
  /// Ready to be drawn: with UVs of each face's own tile.
  TriangleMesh local(const TriangleMesh& mesh) const;
  const TextureSet& set() const { return set_; }
  /// The model with these textures in the place of the set's. It is worth seeing even if one of
  /// them got lost: that part stays grey. \param local_mesh what local() gives
  Image picture(const TriangleMesh& local_mesh, const std::vector<SetTexture>& textures,
                const RenderOptions& options) const;

 private:
  TextureSet set_;
};

/// The image of a texture; null, with a warning, if it got lost: the rest is worth seeing.
std::unique_ptr<Image> read_if_there(const SetTexture& texture);

/// What -t says, or what the mesh's materials name. What is odd about it is warned of.
/// \param files of -t; empty = what the materials name
WornTextures worn_textures(const TriangleMesh& mesh, const std::vector<std::string>& files,
                           const std::optional<std::filesystem::path>& confined_to);

}  // namespace onmesh::tools
