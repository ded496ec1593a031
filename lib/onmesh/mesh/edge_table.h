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

inline bool has_repeated_vertex(const std::array<Index, 3>& face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// For every face the first one on the same three vertices, whichever way it runs; kNone if that is
/// the face itself.
std::vector<Index> earlier_copies(const TriangleMesh& mesh);

/// Which faces to turn over so that the two faces of every edge run along it in opposite
/// directions.
struct Winding {
  std::vector<bool> flip;
  Index conflict = kNone;  ///< a face of a component that cannot be wound; kNone = all can
};

/// The smaller area of every component (over edges with two faces) is what is turned over; nothing
/// of a component that cannot be wound.
Winding consistent_winding(const TriangleMesh& mesh, const EdgeTable& edges);

/// Disjoint sets; the representative of a set is its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    for (std::size_t i = 0; i < size; ++i) parent_[i] = static_cast<Index>(i);
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }

 private:
  std::vector<Index> parent_;
};

/// The corner (3 * face + 0..2) of the side's face that lies on the given end of its edge.
inline Index corner_at(const TriangleMesh& mesh, const EdgeSide& side, Index vertex) {
  const bool starts = mesh.faces[side.face][side.corner] == vertex;
  return 3 * side.face + (starts ? side.corner : (side.corner + 1U) % 3);
}

/// The fans of every vertex, as sets of corners: faces at a vertex that are joined by edges there.
DisjointSets join_fans(const TriangleMesh& mesh, const EdgeTable& edges);

/// The number of fans of every vertex; more than one makes a bow tie.
std::vector<Index> count_fans(const TriangleMesh& mesh, DisjointSets& fans);

}  // namespace onmesh
