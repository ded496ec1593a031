// Boundaries that lie side by side without being joined.
#pragma once

#include <string>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What find_near_boundaries() found.
struct NearBoundaries {
  Index edges = 0;        ///< boundary edges that lie near others
  double width = 0;       ///< of the widest gap between them, mesh units
  bool weldable = false;  ///< join_boundaries() would join nearly all of them across that width

  /// "3 boundary edges lie within a texel of others but stay apart; weld=0.002 would join them", or
  /// bridge=0.002: whichever would.
  std::string text() const;
};

/// Find boundary edges that have a vertex of another boundary, or of another stretch of their own,
/// nearby: the two sides of a gap. Along one stretch, edges are always near each other; what is no
/// more than four times as far along the boundary as straight does not count. Nor do faces that lie
/// on each other, like the sides of cloth: see join_boundaries().
/// \pre mesh is welded, clean, and went through join_boundaries()
/// \param reach per face, how far from its boundary edges counts as near, mesh units; 0 = not at
/// all
NearBoundaries find_near_boundaries(const TriangleMesh& mesh, const std::vector<double>& reach);

}  // namespace onmesh
