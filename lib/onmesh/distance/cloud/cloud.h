// The heat method on a point cloud.
#pragma once

#include <memory>

#include "onmesh/distance/backend.h"
#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"

namespace onmesh {

/// The heat method on the nodes as a point cloud with normals, joined by local Delaunay
/// triangulations (Crane, Weischedel & Wardetzky, Geodesics in heat, 2013, section 3.2.3; Sharp &
/// Crane, A Laplacian for nonmanifold triangle meshes, 2020, section 5.7). Works on any set of
/// triangles.
///
/// A patch becomes another complex on the same nodes, which the solver of mesh heat takes as its
/// own. Of the patch's faces only adjacency and the lengths of their edges count. Adjacency says
/// which points are neighbours, so that close sheets do not leak, and where sheets begin and end.
/// Shapes come from positions and normals, and so do lengths between points that are not adjacent.
/// Bridges join no points: the march over the complex goes across them.
/// \pre the nodes lie on the mesh
std::unique_ptr<DistanceBackend> make_cloud(const TriangleMesh& mesh, const NodeMesh& nodes);

}  // namespace onmesh
