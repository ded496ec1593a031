#include "onmesh/nodes/overlay.h"

#include "onmesh/base/plane.h"
namespace onmesh {

Index Overlay::piece_at(const SurfacePoint& point) const {
  Index best = kNone;
  double most = -1e300;
  for (Index i = face_offsets[point.face]; i < face_offsets[point.face + 1]; ++i) {
    const double least = (pieces[i].to_node * point.barycentric).minCoeff();
    if (least > most) {
      most = least;
      best = i;
    }
  }
  return best;
}

NodePoint Overlay::locate(const SurfacePoint& point) const {
  const Index piece = piece_at(point);
  return piece == kNone ? NodePoint{} : in_piece(piece, point);
}

NodePoint Overlay::in_piece(Index piece, const SurfacePoint& point) const {
  const Vec3 b = (pieces[piece].to_node * point.barycentric).cwiseMax(0.0);
  return {pieces[piece].node_face, b / b.sum()};
}

}  // namespace onmesh
