// The boundary edges of a mesh (internal: what joining and telling of gaps share).
#pragma once

#include <span>
#include <vector>

#include "onmesh/mesh/edge_table.h"

namespace onmesh {

/// An edge with one face, run as that face runs.
struct BoundaryEdge {
  std::array<Index, 2> ends;
  Index face = kNone;
  std::uint8_t corner = 0;  ///< of the face, at the first end
};

/// All of them, in the order of an EdgeTable.
std::vector<BoundaryEdge> boundary_edges(const TriangleMesh& mesh);

/// Numbers of the boundary edges at each vertex, as rows of one array.
class EdgesAtVertices {
 public:
  EdgesAtVertices(const std::vector<BoundaryEdge>& edges, std::size_t vertices);
  std::span<const Index> at(Index vertex) const {
    return {edges_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

 private:
  std::vector<std::size_t> offsets_;
  std::vector<Index> edges_;
};

/// Two faces beside a line lie on each other, like the two sides of cloth at its rim: both on the
/// same side of it, in planes that enclose next to no angle or, where they end, are no farther
/// apart than `thickness`. A face that is no wider than that itself lies on none.
/// \param a, b points of the line
bool lie_on_each_other(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second,
                       const Vec3& a, const Vec3& b, double thickness);

}  // namespace onmesh
