#include "onmesh/subnodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace onmesh {
namespace {

// The real subnodes by their lower-numbered end (CSR), with what the blur needs of them.
struct ByNode {
  std::vector<Index> offsets, subnode, other;
  std::vector<float> quarter_length, half_variance;

  ByNode(const Subnodes& s, std::size_t nodes) : offsets(nodes + 1, 0) {
    for (Index i = 0; i < s.size(); ++i)
      if (s.is_real[i]) ++offsets[std::min(s.ends[i][0], s.ends[i][1]) + 1];
    for (std::size_t n = 0; n < nodes; ++n) offsets[n + 1] += offsets[n];
    subnode.resize(offsets.back());
    other.resize(offsets.back());
    quarter_length.resize(offsets.back());
    half_variance.resize(offsets.back());
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (Index i = 0; i < s.size(); ++i) {
      if (!s.is_real[i]) continue;
      const auto [low, high] = std::minmax(s.ends[i][0], s.ends[i][1]);
      const Index at = next[low]++;
      subnode[at] = i;
      other[at] = high;
      quarter_length[at] = 0.25F * s.squared_length[i];
      half_variance[at] = 0.5F * s.variance[i];
    }
  }
};

void add_variances(const Patch& patch, Subnodes& s) {
  std::vector<double> sum(s.size(), 0), area(s.size(), 0);
  for (Index f = 0; f < patch.corners.size(); ++f) {
    const auto& l = patch.lengths[f];
    const double face_area = triangle_area(l[0], l[1], l[2]);
    const double scale = s.is_split[f] ? 0.25 : 1.0;
    const double v = scale * (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]) / 12;
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

BlurWeights make_blur(const Patch& patch, const DistanceTable& table, const Subnodes& s,
                      double sigma, double radius) {
  const ByNode by_node(s, patch.nodes.size());
  const auto limit = float(radius * radius * (1 + 1e-5)), squared_sigma = float(sigma * sigma);
  const auto half_log2e = float(-0.5 * std::numbers::log2e);
  // The middle of an edge is half an edge from its ends.
  const double reach = radius * std::sqrt(1 + 1e-5) + 1.01 * patch.longest_edge;
  const auto within = float(reach * reach);
  const std::size_t columns = table.columns;

  BlurWeights blur;
  blur.offsets.assign(1, 0);
  std::vector<Index> near(columns);
  std::vector<float> mean(columns);
  std::size_t near_count = 0, count = 0;
  Index last = kNone;
  for (const Index i : s.core) {
    const auto [a, b] = s.ends[i];
    const float *const row_a = table.row(a), *const row_b = table.row(b);
    // No branches in these loops: they would be mispredicted too often.
    if (a != last) {
      last = a;
      near_count = 0;
      for (Index n = 0; n < columns; ++n) {
        near[near_count] = n;
        near_count += row_a[n] <= within;
      }
    }
    for (std::size_t n = 0; n < columns; ++n) mean[n] = 0.5F * row_a[n] + 0.5F * row_b[n];
    const float quarter_length = 0.25F * s.squared_length[i];
    const float own = squared_sigma - 0.5F * s.variance[i];
    for (std::size_t k = 0; k < near_count; ++k) {
      const Index n = near[k];
      const Index begin = by_node.offsets[n], end = by_node.offsets[n + 1];
      if (blur.subnodes.size() < count + (end - begin)) {
        blur.subnodes.resize(2 * (count + (end - begin)) + 1024);
        blur.exponents.resize(blur.subnodes.size());
      }
      // Where an end is not reached the mean is beyond all limits.
      const float half = 0.5F * mean[n] - quarter_length;
      for (Index at = begin; at < end; ++at) {
        const float squared = half + 0.5F * mean[by_node.other[at]] - by_node.quarter_length[at];
        blur.subnodes[count] = by_node.subnode[at];
        blur.exponents[count] =
            std::max(squared, 0.0F) * half_log2e / (own - by_node.half_variance[at]);
        count += squared <= limit;
      }
    }
    blur.offsets.push_back(count);
  }
  blur.subnodes.resize(count);
  blur.exponents.resize(count);
  return blur;
}

}  // namespace onmesh
