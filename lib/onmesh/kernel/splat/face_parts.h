// Faces of a patch, cut into the smaller ones that subnodes are corners of.
#pragma once

#include <array>

#include "onmesh/kernel/splat/subnodes.h"

namespace onmesh {

/// A face of the patch or a part of it. Its barycentric coordinates are scale * b[i] + offset[i], b
/// being those in the patch's face.
struct FacePart {
  std::array<Index, 3> corners{};  ///< subnodes, real or not
  float scale = 1;
  std::array<float, 3> offset{0, 0, 0};
};

/// A quarter of a part, without its corners.
/// \param quarter 0, 1, 2: at the corners; 3: in the middle, its corners opposite the part's
FacePart quarter_of(const FacePart& part, int quarter);

/// What subnodes know of a patch's face: it is whole, or one of the four faces of a halved patch;
/// and each of those is whole or split into four quarters.
struct SplitFace {
  int halves = 1;                 ///< 4 if the patch is halved
  std::array<int, 4> quarters{};  ///< per half: 4 if it is split, else 1
  /// Per quarter, 4 * half + quarter: its corners. A half that is not split is its own quarter 0.
  std::array<std::array<Index, 3>, 16> corners;
};

/// \param patch whose faces were split into `subnodes`
/// \param local_face of the patch, before it was halved
SplitFace split_face(const Patch& patch, const Subnodes& subnodes, bool is_halved,
                     Index local_face);

}  // namespace onmesh
