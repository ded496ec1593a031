#include "onmesh/atlas/face_textures.h"

#include <map>
#include <string>
#include <utility>

namespace onmesh {

FaceTextures number_textures(const TriangleMesh& mesh, bool by_wrap) {
  std::map<std::pair<std::string, int>, Index> numbers;
  const auto number_of = [&](const Material& material) {
    // 0 = its modes are not told or do not count
    const int modes = by_wrap && material.wrap ? 1 + 3 * static_cast<int>(material.wrap->u) +
                                                     static_cast<int>(material.wrap->v)
                                               : 0;
    return numbers.try_emplace({material.texture, modes}, Index(numbers.size())).first->second;
  };
  const Index none = number_of({});
  std::vector<Index> of_material;
  for (const Material& material : mesh.materials) of_material.push_back(number_of(material));
  FaceTextures textures;
  textures.count = Index(numbers.size());
  textures.of_face.reserve(mesh.faces.size());
  for (const Index material : mesh.face_materials)
    textures.of_face.push_back(material == kNone ? none : of_material[material]);
  return textures;
}

}  // namespace onmesh
