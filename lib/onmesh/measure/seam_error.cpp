#include "onmesh/measure/seam_error.h"

#include <algorithm>
#include <cmath>

#include "onmesh/measure/seam_edges.h"

namespace onmesh {

SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map,
                     const std::vector<const Image*>& images, Index tile) {
  SeamError result;
  double squares = 0;
  for (const MeasuredSeam& seam : measure_seams(mesh, map, images)) {
    if (tile != kNone && map.tile_number(seam.face()) != tile &&
        map.tile_number(seam.other_face()) != tile)
      continue;
    squares += seam.length * seam.mean_square;
    result.length += seam.length;
    result.max = std::max(result.max, seam.max);
    ++result.edges;
  }
  if (result.length > 0) result.rms = std::sqrt(squares / result.length);
  return result;
}

SeamError seam_error(const TriangleMesh& mesh, const TexelMap& map, const Image& image) {
  return seam_error(mesh, map, std::vector<const Image*>{&image});
}

}  // namespace onmesh
