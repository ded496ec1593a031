#include "worn_textures.h"

#include <set>

#include "interruption.h"
#include "messages.h"
#include "onmesh/base/error.h"

namespace onmesh::tools {

void WornTextures::add(const TextureSet& set) {
  const auto first = Index(set_.textures.size());
  set_.textures.insert(set_.textures.end(), set.textures.begin(), set.textures.end());
  for (Index f = 0; f < set.tile_of_face.size(); ++f) {
    if (set.tile_of_face[f] != kNone) set_.tile_of_face[f] = first + set.tile_of_face[f];
  }
}

TriangleMesh WornTextures::local(const TriangleMesh& mesh) const {
  std::vector<TextureTile> tiles;
  for (const SetTexture& texture : set_.textures)
    tiles.push_back({nullptr, {}, texture.column(), texture.row(), {}});
  TriangleMesh result = mesh;
  if (!tiles.empty()) make_uvs_local(tiles, set_.tile_of_face, result);
  return result;
}

Image WornTextures::picture(const TriangleMesh& local_mesh, const std::vector<SetTexture>& textures,
                            const RenderOptions& options) const {
  std::vector<std::unique_ptr<Image>> images;
  for (const SetTexture& texture : textures) {
    check_interrupted();
    images.push_back(read_if_there(texture));
  }
  RenderColour colour;
  for (const Index tile : set_.tile_of_face)
    colour.face_textures.push_back(tile == kNone ? nullptr : images[tile].get());
  return render(local_mesh, colour, options);
}

std::unique_ptr<Image> read_if_there(const SetTexture& texture) {
  std::unique_ptr<Image> image;
  std::vector<std::string> odd;
  try {
    image = std::make_unique<Image>(read_texture(texture, odd));
  } catch (const FileError& error) {
    warn(error.what());
  } catch (const InputError& error) {
    warn(error.what());
  }
  warn(odd);
  return image;
}

WornTextures worn_textures(const TriangleMesh& mesh, const std::vector<std::string>& files,
                           const std::optional<std::filesystem::path>& confined_to) {
  WornTextures worn(mesh);
  if (!files.empty()) {
    const TextureSet set = choose_textures(mesh, {files, {}, {}});
    warn(set.warnings);
    worn.add(set);
    return worn;
  }
  std::set<std::string> done;
  for (const Material& material : mesh.materials) {
    if (material.texture.empty() || !done.insert(material.texture).second) continue;
    try {
      const TextureSet set = choose_textures(mesh, {{material.texture}, {}, {}, confined_to});
      warn(set.warnings);
      worn.add(set);
    } catch (const FileError& error) {
      warn(error.what());
    } catch (const InputError& error) {
      warn(error.what());
    } catch (const UsageError&) {
      // No face wears it.
    }
  }
  return worn;
}

}  // namespace onmesh::tools
