// Surface inside a ball: what is close in space *and* on the surface.
#pragma once

#include <vector>

#include "onmesh/triangle_mesh.h"

namespace onmesh {

/// Finds the faces that a ball around a surface point meets in the piece of surface that contains
/// the point: the other side of a thin sheet is in the ball, but not in that piece. Works on any
/// triangle complex: faces are joined across edges of any number of faces and at vertices.
/// Not for concurrent use: a query leaves its marks in the object.
class SurfaceBall {
 public:
  /// \pre mesh is welded; it must outlive this
  explicit SurfaceBall(const TriangleMesh& mesh);

  /// Faces joined to `face` inside the open ball, `face` itself first; valid until the next call.
  /// A face meets a ball in a convex piece, so every point of a face found that is within `radius`
  /// of `centre` is joined to it inside the ball.
  /// \pre centre lies on face
  const std::vector<Index>& find(Index face, const Vec3& centre, double radius);

  /// What the last find() found.
  const std::vector<Index>& result() const { return result_; }
  bool found(Index face) const { return face_marks_[face] == mark_; }

 private:
  void add(Index face);
  void start_marks();

  const TriangleMesh& mesh_;
  std::vector<Index> corner_edges_;               // 3 per face: edge from corner k to k + 1
  std::vector<Index> edge_offsets_, edge_faces_;  // faces of each edge
  std::vector<Index> vertex_offsets_, vertex_faces_;
  std::vector<Index> face_marks_, edge_marks_, vertex_marks_;  // == mark_: seen by the last find()
  Index mark_ = 0;
  std::vector<Index> result_;
};

}  // namespace onmesh
