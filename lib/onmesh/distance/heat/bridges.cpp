#include "onmesh/distance/heat/bridges.h"

#include <algorithm>

#include "onmesh/distance/unfold.h"

namespace onmesh::heat {
namespace {

double longest_edge(const Patch& patch) {
  double longest = 0;
  for (const auto& l : patch.lengths) longest = std::max({longest, l[0], l[1], l[2]});
  return longest;
}

}  // namespace

Patch surface_of(const Patch& patch) {
  Patch surface = patch;
  const std::size_t faces = patch.corners.size() - patch.bridge_faces;
  surface.faces.resize(faces);
  surface.corners.resize(faces);
  surface.lengths.resize(faces);
  if (!surface.neighbours.empty()) surface.neighbours.resize(faces);
  surface.bridge_faces = 0;
  surface.longest_edge = longest_edge(surface);
  return surface;
}

Patch with_bridges(Patch surface, const Patch& patch) {
  surface.corners.insert(surface.corners.end(), patch.corners.end() - patch.bridge_faces,
                         patch.corners.end());
  surface.lengths.insert(surface.lengths.end(), patch.lengths.end() - patch.bridge_faces,
                         patch.lengths.end());
  if (!surface.neighbours.empty())
    surface.neighbours.resize(surface.corners.size(), {kNone, kNone, kNone});
  surface.bridge_faces = patch.bridge_faces;
  surface.longest_edge = longest_edge(surface);
  return surface;
}

void cross_bridges(const Patch& surface, const Patch& bridged, double reach, DistanceTable& table) {
  // Of squares: below, the two marches differ by rounding only.
  constexpr float kShorter = 1 - 1e-4F;
  const auto march = make_unfold();
  DistanceTable without, with;
  march->fill(surface, Reach::up_to(reach), without);
  march->fill(bridged, Reach::up_to(reach), with);
  for (std::size_t i = 0; i < table.squared.size(); ++i)
    if (with.squared[i] < kShorter * without.squared[i]) table.squared[i] = with.squared[i];
}

}  // namespace onmesh::heat
