#include "onmesh/atlas/charts_of_texels.h"

namespace onmesh {

std::vector<Index> charts_of_texels(const TexelMap& map) {
  std::vector<Index> charts(map.coverage.size(), kNone);
  for (Index f = 0; f + 1 < map.face_offsets.size(); ++f) {
    const TexelTile tile = map.tile_of(f);
    for (Index k = map.face_offsets[f]; k < map.face_offsets[f + 1]; ++k) {
      Index& chart = charts[tile.texel(map.claims[k])];
      if (chart == kNone) chart = map.chart_of_face[f];
    }
  }
  return charts;
}

}  // namespace onmesh
