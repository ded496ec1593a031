#include "onmesh/atlas/charts.h"

#include <algorithm>
#include <utility>

#include "onmesh/base/disjoint_sets.h"

namespace onmesh {

Charts find_charts(const UvNeighbours& neighbours, const std::vector<bool>& used,
                   const std::vector<bool>& holds_texels, const std::vector<Index>& image_of_face) {
  const auto faces = static_cast<Index>(used.size());
  const auto image_of = [&](Index f) { return image_of_face.empty() ? 0 : image_of_face[f]; };
  DisjointSets sets(faces);
  neighbours.each_shared_edge([&](std::vector<Index>& sharing) {
    std::sort(sharing.begin(), sharing.end(), [&](Index f, Index g) {
      return std::pair(image_of(f), f) < std::pair(image_of(g), g);
    });
    for (std::size_t i = 1; i < sharing.size(); ++i)
      if (image_of(sharing[i]) == image_of(sharing[i - 1])) sets.join(sharing[i - 1], sharing[i]);
  });
  // Faces that hold no texels connect what lies beside them, but have no number.
  std::vector<Index> roots(faces, kNone);
  for (Index f = 0; f < faces; ++f) {
    if (holds_texels[f]) roots[f] = sets.find(f);
  }
  NumberedSets numbered = number_sets(std::move(roots));
  return {std::move(numbered.numbers), numbered.count};
}

}  // namespace onmesh
