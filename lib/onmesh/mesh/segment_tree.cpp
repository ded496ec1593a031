#include "onmesh/mesh/segment_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace onmesh {

SegmentTree::SegmentTree(std::vector<Segment> segments, std::vector<double> reaches)
    : segments_(std::move(segments)), reaches_(std::move(reaches)) {
  reaches_.resize(segments_.size(), std::numeric_limits<double>::infinity());
  order_.resize(segments_.size());
  for (Index i = 0; i < order_.size(); ++i) order_[i] = i;
  std::size_t nodes = 1;
  for (std::size_t held = kLeaf; held < order_.size(); held *= 2) nodes = 2 * nodes + 1;
  boxes_.resize(nodes);
  if (!order_.empty()) build({0, 0, static_cast<Index>(order_.size())});
  segments_ = {};  // the boxes tell enough
  reaches_ = {};
}

void SegmentTree::build(const Node& node) {
  Box& box = boxes_[node.number];
  box = {segments_[order_[node.begin]][0], segments_[order_[node.begin]][0], 0};
  for (Index i = node.begin; i < node.end; ++i) {
    box.reach = std::max(box.reach, reaches_[order_[i]]);
    for (const Vec3& end : segments_[order_[i]]) {
      box.low = box.low.cwiseMin(end);
      box.high = box.high.cwiseMax(end);
    }
  }
  if (node.is_leaf()) return;
  Eigen::Index axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const auto at = [&](Index i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto key = [&](Index i) {
    return std::pair(segments_[i][0][axis] / 2 + segments_[i][1][axis] / 2, i);
  };
  std::nth_element(at(node.begin), at(node.middle()), at(node.end),
                   [&](Index i, Index j) { return key(i) < key(j); });
  build(node.left());
  build(node.right());
}

/// The query's segment is clipped to the box, as large as the radius makes it, plane by plane.
bool SegmentTree::may_hold(const Box& box, const Query& query) const {
  const double radius = std::min(query.radius, box.reach);
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const double low = box.low[k] - radius - query.a[k];
    const double high = box.high[k] + radius - query.a[k];
    const double way = query.b[k] - query.a[k];
    if (way == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double s = low / way, t = high / way;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
    if (from > to * (1 + 1e-12)) return false;
  }
  return true;
}

}  // namespace onmesh
