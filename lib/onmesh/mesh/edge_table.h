// Edges of a mesh with the faces around them.
#pragma once

#include <span>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A face's side that lies on an edge: from its corner `corner` to the next corner.
struct EdgeSide {
  Index face = kNone;
  std::uint8_t corner = 0;
  bool forward = true;  ///< runs from the edge's lower vertex to its higher one
};

/// Every edge once, in ascending order of its vertices, sides in ascending order of faces. Faces
/// with a repeated vertex have no edges here.
class EdgeTable {
 public:
  explicit EdgeTable(const TriangleMesh& mesh);

  std::size_t size() const { return vertices_.size(); }
  /// The edge's vertices, the lower one first.
  const std::array<Index, 2>& vertices(std::size_t edge) const { return vertices_[edge]; }
  std::span<const EdgeSide> sides(std::size_t edge) const {
    return {sides_.data() + offsets_[edge], offsets_[edge + 1] - offsets_[edge]};
  }
  /// Both of the edge's two faces run along it in the same direction.
  bool inconsistent(std::size_t edge) const {
    const auto s = sides(edge);
    return s.size() == 2 && s[0].forward == s[1].forward;
  }

 private:
  std::vector<std::array<Index, 2>> vertices_;
  std::vector<std::size_t> offsets_;
  std::vector<EdgeSide> sides_;
};

/// The corner (3 * face + 0..2) of the side's face that lies on the given end of its edge.
inline Index corner_at(const TriangleMesh& mesh, const EdgeSide& side, Index vertex) {
  const bool starts = mesh.faces[side.face][side.corner] == vertex;
  return 3 * side.face + (starts ? side.corner : (side.corner + 1U) % 3);
}

}  // namespace onmesh
