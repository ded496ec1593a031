// Edges with vertices of another part on them (internal).
#pragma once

#include <vector>

#include "onmesh/mesh/boundary.h"
#include "onmesh/mesh/scaled_points.h"

namespace onmesh {

/// A vertex at which a face's edge is to be split.
struct EdgeSplit {
  Index face = kNone;
  std::uint8_t corner = 0;  ///< where the edge begins
  double position = 0;      ///< on the edge, in (0, 1)
  Index vertex = kNone;
  Index uv = kNone;  ///< one that the mesh has and that is right there; kNone = interpolate
};

/// Boundary vertices that lie within the tolerance of the interior of a boundary edge, as
/// join_boundaries() describes; ascending by faces, their corners and positions. Those that are
/// within the tolerance of the one before on the edge are left out.
/// \param left_apart per vertex, that it is not to be joined to anything
std::vector<EdgeSplit> find_t_junctions(const TriangleMesh& mesh,
                                        const std::vector<BoundaryEdge>& edges,
                                        const ScaledPoints& scaled,
                                        const std::vector<bool>& left_apart);

/// Make several faces of each face whose edges are to be split, in its place. Materials are kept,
/// UVs are linear between the corners, normals are dropped.
/// \param splits as find_t_junctions() gives them
/// \return per face of the result the face before that it is (a part of)
std::vector<Index> split_faces(TriangleMesh& mesh, const std::vector<EdgeSplit>& splits);

}  // namespace onmesh
