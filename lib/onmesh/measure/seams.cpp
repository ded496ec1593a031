#include "onmesh/measure/seams.h"

#include "onmesh/atlas/unfolded_walk.h"

namespace onmesh {

namespace {

std::vector<Seam> find_edges(const TriangleMesh& mesh, const TexelMap& map, bool in_charts) {
  const UnfoldedWalk walk(mesh, map);
  std::vector<Seam> seams;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index other = walk.across(f, k);
      if (other == kNone || (walk.across_in_chart(f, k) == other) != in_charts) continue;
      // Once, unless the surface branches and the way back leads elsewhere.
      const Index g = other / 3;
      const bool mutual = walk.across(g, int(other % 3)) == 3 * f + Index(k);
      if (mutual && g < f) continue;
      if (map.chart_of_face[f] == kNone || map.chart_of_face[g] == kNone) continue;
      const bool opposed = mesh.faces[f][std::size_t(k)] == mesh.faces[g][(other % 3 + 1) % 3];
      seams.push_back({3 * f + Index(k), other, opposed});
    }
  }
  return seams;
}

}  // namespace

std::vector<Seam> find_seams(const TriangleMesh& mesh, const TexelMap& map) {
  return find_edges(mesh, map, false);
}

std::vector<Seam> find_chart_edges(const TriangleMesh& mesh, const TexelMap& map) {
  return find_edges(mesh, map, true);
}

}  // namespace onmesh
