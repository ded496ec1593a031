#include "onmesh/mesh/winding.h"

#include <algorithm>

namespace onmesh {

Winding consistent_winding(const TriangleMesh& mesh, const EdgeTable& edges) {
  constexpr std::uint32_t kBoundary = kNone;
  struct Neighbour {
    Index face = kBoundary;
    bool same_direction = false;
  };
  std::vector<std::array<Neighbour, 3>> neighbours(mesh.faces.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto s = edges.sides(e);
    if (s.size() != 2) continue;
    neighbours[s[0].face][s[0].corner] = {s[1].face, edges.inconsistent(e)};
    neighbours[s[1].face][s[1].corner] = {s[0].face, edges.inconsistent(e)};
  }
  Winding result;
  result.flip.assign(mesh.faces.size(), false);
  std::vector<bool> seen(mesh.faces.size(), false);
  std::vector<Index> component;
  for (Index seed = 0; seed < mesh.faces.size(); ++seed) {
    if (seen[seed]) continue;
    component.assign(1, seed);
    seen[seed] = true;
    double kept_area = 0, flipped_area = 0;
    bool one_sided = false;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const Index f = component[i];
      (result.flip[f] ? flipped_area : kept_area) += mesh.face_area(f);
      for (const Neighbour& n : neighbours[f]) {
        if (n.face == kBoundary) continue;
        const bool flip = result.flip[f] != n.same_direction;
        if (!seen[n.face]) {
          seen[n.face] = true;
          result.flip[n.face] = flip;
          component.push_back(n.face);
        } else if (result.flip[n.face] != flip) {
          one_sided = true;
          result.conflict = std::min(result.conflict, f);
        }
      }
    }
    if (one_sided) {
      for (const Index f : component) result.flip[f] = false;
    } else if (flipped_area > kept_area) {
      for (const Index f : component) result.flip[f] = !result.flip[f];
    }
  }
  return result;
}

}  // namespace onmesh
