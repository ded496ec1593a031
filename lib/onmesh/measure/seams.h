// Where the seams of an atlas are.
#pragma once

#include <vector>

#include "onmesh/atlas/texel_map.h"

namespace onmesh {

/// An edge with two faces; as a seam they carry the texture with different UVs there.
struct Seam {
  Index side;        ///< 3 * face + its edge
  Index other_side;  ///< the same of the other face
  bool opposed;      ///< the faces run along it in opposite directions

  Index face() const { return side / 3; }
  Index other_face() const { return other_side / 3; }
};

/// Every seam once; where more than two faces meet, each is paired with the one that goes on most
/// straight.
/// \pre mesh and map belong together
std::vector<Seam> find_seams(const TriangleMesh& mesh, const TexelMap& map);

/// The edges within charts, likewise.
std::vector<Seam> find_chart_edges(const TriangleMesh& mesh, const TexelMap& map);

}  // namespace onmesh
