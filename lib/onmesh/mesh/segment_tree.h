// Which of some segments lie near a point or a segment (internal).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// A balanced tree of bounding boxes over segments, which may be points; queries are const and may
/// run in parallel.
class SegmentTree {
 public:
  using Segment = std::array<Vec3, 2>;

  /// \param reaches per segment, beyond which it is of no use: it is then left out also where the
  ///   query's radius is larger. Empty = none. What is small is passed by in searches for the
  ///   neighbours of what is large, however much of it there is.
  /// \pre ends are finite
  explicit SegmentTree(std::vector<Segment> segments, std::vector<double> reaches = {});

  /// Call visit(number) for all segments within `radius` and their own reach of the one from a to
  /// b, and for some that are farther away, in the same order every time. It returns the radius to
  /// go on with; negative = that is all.
  template <class Visit>
  void visit_near(const Vec3& a, const Vec3& b, double radius, const Visit& visit) const {
    Query query{a, b, radius};
    if (!order_.empty()) descend({0, 0, static_cast<Index>(order_.size())}, query, visit);
  }

 private:
  static constexpr Index kLeaf = 8;  // segments at most

  struct Box {
    Vec3 low, high;
    double reach;  // the largest of its segments
  };
  struct Node {
    Index number;      // children of node n are 2 n + 1 and 2 n + 2
    Index begin, end;  // into order_
    Index middle() const { return begin + (end - begin) / 2; }
    Node left() const { return {2 * number + 1, begin, middle()}; }
    Node right() const { return {2 * number + 2, middle(), end}; }
    bool is_leaf() const { return end - begin <= kLeaf; }
  };
  struct Query {
    Vec3 a, b;
    double radius;
  };

  void build(const Node& node);
  bool may_hold(const Box& box, const Query& query) const;

  template <class Visit>
  void descend(const Node& node, Query& query, const Visit& visit) const {
    if (query.radius < 0 || !may_hold(boxes_[node.number], query)) return;
    if (node.is_leaf()) {
      for (Index i = node.begin; i < node.end && query.radius >= 0; ++i)
        query.radius = visit(order_[i]);
    } else {
      descend(node.left(), query, visit);
      descend(node.right(), query, visit);
    }
  }

  std::vector<Segment> segments_;  // while the tree is built
  std::vector<double> reaches_;    // the same
  std::vector<Index> order_;       // numbers of the segments, leaf by leaf
  std::vector<Box> boxes_;         // per node
};

}  // namespace onmesh
