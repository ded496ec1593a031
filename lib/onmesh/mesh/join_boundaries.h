// Joining surfaces at boundaries that were meant to coincide.
#pragma once

#include <optional>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// What join_boundaries() did.
struct JoinReport {
  Index joined_edges = 0;     ///< pairs of boundary edges that became one edge
  Index t_junctions = 0;      ///< places where a boundary edge was split at a vertex beside it
  Index refused_edges = 0;    ///< boundary edges with others within reach, left as they were
  std::vector<Index> vertex;  ///< per vertex of the mesh given, its number in the result
  std::vector<Index> face;    ///< per face of the result, the face given that it is (a part of)

  /// Nothing was joined: the result is the mesh given.
  bool nothing_done() const { return joined_edges == 0 && t_junctions == 0; }
};

/// Join boundary edges (edges with one face) that differ by rounding, and split them where the
/// vertices of one side lie on the edges of the other.
///
/// Two boundary edges become one if both pairs of their ends lie within the tolerance and neither
/// edge has another such partner; partners that run the other way, as neighbours wound alike do, go
/// before those that run the same way. A boundary edge is split at every boundary vertex that lies
/// within the tolerance of its interior; its face becomes several, with UVs interpolated along the
/// edge. Merged vertices get the position of the first of them.
///
/// The tolerance is at most an eighth of the shorter one of two edges, so that none collapses.
/// Where merging would draw vertices together that are farther apart than the tolerance, or that an
/// edge connects, all edges that meet there are left as they are. Faces that would come to lie on
/// each other, like the two sides of cloth at its rim, stay apart.
///
/// Takes n log n time. Nothing is changed where there is nothing to join.
/// \pre mesh is welded, its positions are finite
/// \param tolerance mesh units, >= 0; 0 = join nothing. Default: two steps of the coordinates as
///   they were stored, see CoordinatePrecision
/// \param report if given, receives what was done
TriangleMesh join_boundaries(const TriangleMesh& mesh, std::optional<double> tolerance = {},
                             JoinReport* report = nullptr);

}  // namespace onmesh
