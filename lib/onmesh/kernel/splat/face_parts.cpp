#include "onmesh/kernel/splat/face_parts.h"

namespace onmesh {
namespace {

/// The corners of a quarter of a split face; of the face if it is not split.
std::array<Index, 3> corners_of(const Patch& patch, const Subnodes& subnodes, Index local_face,
                                int quarter) {
  const std::array<Index, 3>& corners = patch.corners[local_face];
  const std::array<Index, 3>& middle = subnodes.middle[local_face];
  if (subnodes.is_split[local_face] == 0) return corners;
  switch (quarter) {
    case 0:
      return {corners[0], middle[0], middle[2]};
    case 1:
      return {middle[0], corners[1], middle[1]};
    case 2:
      return {middle[2], middle[1], corners[2]};
    default:
      return {middle[1], middle[2], middle[0]};
  }
}

}  // namespace

FacePart quarter_of(const FacePart& part, int quarter) {
  const float scale = quarter < 3 ? 2.0F : -2.0F;
  FacePart result;
  result.scale = scale * part.scale;
  for (int i = 0; i < 3; ++i) {
    const float own = quarter == 3 ? 1.0F : quarter == i ? -1.0F : 0.0F;
    result.offset[i] = scale * part.offset[i] + own;
  }
  return result;
}

SplitFace split_face(const Patch& patch, const Subnodes& subnodes, bool is_halved,
                     Index local_face) {
  SplitFace face;
  face.halves = is_halved ? 4 : 1;
  for (int half = 0; half < face.halves; ++half) {
    const Index f = Index(face.halves) * local_face + Index(half);
    face.quarters[half] = subnodes.is_split[f] != 0 ? 4 : 1;
    for (int quarter = 0; quarter < face.quarters[half]; ++quarter)
      face.corners[4 * half + quarter] = corners_of(patch, subnodes, f, quarter);
  }
  return face;
}

}  // namespace onmesh
