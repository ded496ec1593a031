#include "onmesh/patches/patch_edges.h"

#include <algorithm>
#include <tuple>

namespace onmesh {

std::vector<std::array<Index, 3>> number_edges(const Patch& patch, Index& count) {
  const Index faces = Index(patch.corners.size());
  std::vector<std::array<Index, 3>> number(faces, {kNone, kNone, kNone});
  struct Side {
    Index low, high;
    double length;
    Index half_edge;
  };
  std::vector<Side> sides;
  count = 0;
  for (Index f = 0; f < faces; ++f)
    for (Index k = 0; k < 3; ++k) {
      if (number[f][k] != kNone) continue;
      const Index across = patch.neighbours.empty() ? kNone : patch.neighbours[f][k];
      if (across != kNone) {
        number[f][k] = number[across / 3][across % 3] = count++;
        continue;
      }
      const auto [low, high] = std::minmax(patch.corners[f][k], patch.corners[f][(k + 1) % 3]);
      sides.push_back({low, high, patch.lengths[f][k], 3 * f + k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.length, a.half_edge) <
           std::tie(b.low, b.high, b.length, b.half_edge);
  });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool same = i > 0 && sides[i].low == sides[i - 1].low &&
                      sides[i].high == sides[i - 1].high &&
                      sides[i].length - sides[i - 1].length <= 1e-9 * sides[i].length;
    if (!same) ++count;
    number[sides[i].half_edge / 3][sides[i].half_edge % 3] = count - 1;
  }
  return number;
}

}  // namespace onmesh
