#include "onmesh/kernel/splat/subnodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "onmesh/patches/patch_edges.h"

namespace onmesh {
namespace {

void add_variances(const Patch& patch, Subnodes& s) {
  std::vector<double> sum(s.size(), 0), area(s.size(), 0);
  for (Index f = 0; f < patch.corners.size(); ++f) {
    const auto& l = patch.lengths[f];
    // Only weights: cancellation in needles does no harm.
    const double a = l[0] * l[0], b = l[1] * l[1], c = l[2] * l[2];
    const double face_area =
        std::sqrt(std::max(4 * a * b - (a + b - c) * (a + b - c), 1e-12 * a * b));
    const double scale = s.is_split[f] ? 0.25 : 1.0;
    const double v = scale * (a + b + c) / 12;
    for (int k = 0; k < 3; ++k) {
      for (const Index i : {patch.corners[f][k], s.middle[f][k]}) {
        sum[i] += face_area * v;
        area[i] += face_area;
      }
    }
  }
  s.variance.resize(s.size());
  for (Index i = 0; i < s.size(); ++i) s.variance[i] = area[i] > 0 ? float(sum[i] / area[i]) : 0;
}

}  // namespace

Subnodes make_subnodes(const Patch& patch, double longest) {
  Subnodes s;
  Index edges = 0;
  s.middle = number_edges(patch, edges);
  const Index nodes = Index(patch.nodes.size());
  s.ends.resize(nodes + edges);
  s.squared_length.assign(nodes + edges, 0);
  s.is_real.assign(nodes + edges, 1);
  for (Index n = 0; n < nodes; ++n) s.ends[n] = {n, n};
  s.is_split.assign(patch.corners.size(), 0);
  for (Index f = 0; f < patch.corners.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index m = s.middle[f][k] += nodes;
      const double l = patch.lengths[f][k];
      s.ends[m] = {patch.corners[f][k], patch.corners[f][(k + 1) % 3]};
      s.squared_length[m] = float(l * l);
      s.is_real[m] = l > longest;
      s.is_split[f] |= s.is_real[m];
    }
  }
  add_variances(patch, s);
  for (Index f = 0; f < patch.core_faces; ++f) {
    for (int k = 0; k < 3; ++k) {
      s.core.push_back(patch.corners[f][k]);
      if (s.is_real[s.middle[f][k]]) s.core.push_back(s.middle[f][k]);
    }
  }
  // By their first ends, whose rows of the table are then used several times in a row.
  std::sort(s.core.begin(), s.core.end(), [&](Index i, Index j) {
    return std::pair(s.ends[i][0], i) < std::pair(s.ends[j][0], j);
  });
  s.core.erase(std::unique(s.core.begin(), s.core.end()), s.core.end());
  return s;
}

}  // namespace onmesh
