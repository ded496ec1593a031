// Where a surface was cut into pieces: boundary edges of an intrinsic triangulation that lie on
// each other.
#pragma once

#include <span>
#include <vector>

#include "onmesh/base/types.h"

namespace onmesh {

/// The edges that a mesh was cut along. A cut edge has a side on every piece that meets there; each
/// is a boundary half-edge, named by its tail, from which no other starts. All sides of an edge
/// must be split at once and in the middle.
class CutEdges {
 public:
  struct Side {
    Index tail = kNone;
    bool forward = true;  ///< sides that are not forward run against those that are
  };

  bool empty() const { return edges_.empty(); }
  void add(std::vector<Side> sides);
  /// The sides of the edge that the boundary half-edge at this tail belongs to; empty if it is on
  /// no cut.
  std::span<const Side> sides(Index tail) const;
  /// Note that the sides of an edge were split.
  /// \param tail of any of its sides
  /// \param middles the new nodes, one per side
  /// \pre sides(tail) is not empty
  void split(Index tail, const std::vector<Index>& middles);

  const std::vector<std::vector<Side>>& edges() const { return edges_; }
  /// The middles given to each split(): nodes that are one node on the cut.
  const std::vector<std::vector<Index>>& middles() const { return middles_; }

 private:
  void name(Index edge);

  std::vector<std::vector<Side>> edges_;
  std::vector<Index> edge_at_;  // per tail
  std::vector<std::vector<Index>> middles_;
};

}  // namespace onmesh
