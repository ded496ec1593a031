// Which textures are meant, and which faces of the mesh carry each.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "colour_spaces.h"
#include "onmesh/base/error.h"
#include "onmesh/filter/surface_textures.h"
#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh::tools {

/// One file of the set.
struct SetTexture {
  std::filesystem::path path;  ///< of one inside the mesh file a name: scene.glb/wood.png
  std::string material;        ///< the first one that names it; empty if none does
  int udim = 0;                ///< UDIM tile, 1001 to 9999; 0 = not a tile of several
  bool is_written = true;      ///< else it is context: read, filtered, not written
  std::shared_ptr<const std::string> content = nullptr;  ///< if it is inside the mesh file
  Role role = Role::unknown;                             ///< as map.png@data says
  std::string map = {};                                  ///< of several; empty = the only one
  std::string place = {};  ///< where a mesh file names it, as Material::place

  int column() const { return udim == 0 ? 0 : (udim - 1001) % 10; }
  int row() const { return udim == 0 ? 0 : (udim - 1001) / 10; }
};

/// Textures that are filtered together.
struct TextureSet {
  std::vector<SetTexture> textures;
  std::vector<Index> tile_of_face;  ///< per face, into textures; kNone = carries no texels
  std::string reason;               ///< for the report: how textures and faces were found
  std::vector<std::string> warnings;
};

/// What the command line says about textures.
struct TextureRequest {
  std::vector<std::string> files;       ///< -t; empty = those that the mesh's materials name
  std::optional<std::string> material;  ///< --material
  std::vector<int> only;                ///< --only: UDIM tiles to write; empty = all
  /// Files that lie outside this folder are refused; none = they may lie anywhere.
  std::optional<std::filesystem::path> confined_to = std::nullopt;
  bool may_be_none = false;  ///< no textures if the materials name none, instead of an error
};

/// Find textures and faces.
///
/// Without files all textures that materials name, and `material` chooses those to be written. One
/// file is for the faces whose material names it (or a file of its name), else those of the only
/// textured material, else all; `material` decides where that is not enough: a material's name, or
/// "all" for all faces. Several files are each for the faces whose material names them. `<UDIM>`,
/// `<UVTILE>` and `{material}` in a name stand for what is there; x.1001.png with UVs beyond the
/// tile is taken for one of several UDIM tiles.
/// \throw InputError for a file outside the folder that the request is confined to
/// A role may stand behind each name: see split_role().
/// \throw UsageError that says what to give; FileError for a pattern that no file matches, or a
///   missing file, naming the material
TextureSet choose_textures(const TriangleMesh& mesh, const TextureRequest& request);

/// One file on the faces that another one is on.
/// \param file with its role
/// \throw FileError if it is missing
TextureSet textures_like(const std::vector<Index>& tile_of_face, const std::string& file);

/// 0 for the faces of a material, or for all (none or "all"); kNone for the others.
/// \throw UsageError if no face has that material
std::vector<Index> faces_of_material(const TriangleMesh& mesh,
                                     const std::optional<std::string>& material);

/// The image of a texture.
/// \param warnings receives what is odd about its file
/// \throw FileError, InputError as read_image(), naming its place in the mesh file
Image read_texture(const SetTexture& texture, std::vector<std::string>& warnings);

/// What is inside a mesh file must not become much larger than that, all together.
/// \param images of the set's first textures
/// \throw InputError naming the mesh file
void refuse_image_bombs(const TextureSet& set, const std::vector<Image>& images);

/// Put another set's textures behind those of a set; faces stay as they are.
void append(TextureSet more, TextureSet& set);

/// Forget the textures that are not written, and that faces carry them.
void keep_written(TextureSet& set);

/// Calls work(), which chooses textures; if there is none to choose, the error says what was odd
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
