#include "onmesh/atlas/face_textures.h"

#include <map>
#include <string>

namespace onmesh {

FaceTextures number_textures(const TriangleMesh& mesh) {
  std::map<std::string, Index> numbers;
  const auto number_of = [&](const std::string& texture) {
    return numbers.try_emplace(texture, Index(numbers.size())).first->second;
  };
  const Index none = number_of({});
  std::vector<Index> of_material;
  for (const Material& material : mesh.materials)
    of_material.push_back(number_of(material.texture));
  FaceTextures textures;
  textures.count = Index(numbers.size());
  textures.of_face.reserve(mesh.faces.size());
  for (const Index material : mesh.face_materials)
    textures.of_face.push_back(material == kNone ? none : of_material[material]);
  return textures;
}

}  // namespace onmesh
