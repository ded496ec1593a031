// Surface inside a ball: what is close in space *and* on the surface (internal).
#pragma once

#include <memory>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Finds the faces that a ball around a surface point meets in the piece of surface that contains
/// the point: the other side of a thin sheet is in the ball, but not in that piece.
///
/// Works on any triangle complex: faces are joined across edges of any number of faces and at
/// vertices. Not for concurrent use, since a query leaves its marks in the object; copies share
/// what does not change, so each thread may have one.
class ConnectedBall {
 public:
  /// \pre mesh is welded; it must outlive this
  explicit ConnectedBall(const TriangleMesh& mesh);

  /// Faces joined to `face` inside the open ball, `face` itself first; valid until the next call.
  /// A face meets a ball in a convex piece, so every point of a face found that is within `radius`
  /// of `centre` is joined to it inside the ball.
  /// \param radius mesh units
  /// \pre centre lies on the face
  const std::vector<Index>& find(Index face, const Vec3& centre, double radius);

  /// What the last find() found.
  const std::vector<Index>& result() const { return result_; }
  /// Whether the last find() found the face.
  bool found(Index face) const { return face_marks_[face] == mark_; }

 private:
  struct Joins {
    std::vector<Index> corner_edges;              // 3 per face: edge from corner k to k + 1
    std::vector<Index> edge_offsets, edge_faces;  // faces of each edge
    std::vector<Index> vertex_offsets, vertex_faces;
  };
  static Joins make_joins(const TriangleMesh& mesh);
  void add(Index face);
  void start_marks();

  const TriangleMesh* mesh_;
  std::shared_ptr<const Joins> joins_;
  std::vector<Index> face_marks_, edge_marks_, vertex_marks_;  // == mark_: seen by the last find()
  Index mark_ = 0;
  std::vector<Index> result_;
};

}  // namespace onmesh
