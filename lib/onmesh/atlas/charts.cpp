#include "onmesh/atlas/charts.h"

#include "onmesh/mesh/edge_table.h"

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
  Charts charts;
  charts.chart_of_face.assign(faces, kNone);
  std::vector<Index> number(faces, kNone);  // per set, at its lowest face
  for (Index f = 0; f < faces; ++f) {
    if (!holds_texels[f]) continue;
    Index& n = number[sets.find(f)];
    if (n == kNone) n = charts.count++;
    charts.chart_of_face[f] = n;
  }
  return charts;
}

}  // namespace onmesh
