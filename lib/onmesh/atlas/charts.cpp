#include "onmesh/atlas/charts.h"

#include <utility>

#include "onmesh/base/disjoint_sets.h"

namespace onmesh {

Charts find_charts(const UvNeighbours& neighbours, const std::vector<bool>& used,
                   const std::vector<bool>& holds_texels, const std::vector<Index>& image_of_face) {
  const auto faces = static_cast<Index>(used.size());
  DisjointSets sets(faces);
  for (Index f = 0; f < faces; ++f) {
    if (!used[f]) continue;
    for (int k = 0; k < 3; ++k) {
      neighbours.across_edge(f, k, [&](Index g) {
        if (image_of_face.empty() || image_of_face[f] == image_of_face[g]) sets.join(f, g);
      });
    }
  }
  // Faces that hold no texels connect what lies beside them, but have no number.
  std::vector<Index> roots(faces, kNone);
  for (Index f = 0; f < faces; ++f) {
    if (holds_texels[f]) roots[f] = sets.find(f);
  }
  NumberedSets numbered = number_sets(std::move(roots));
  return {std::move(numbered.numbers), numbered.count};
}

}  // namespace onmesh
