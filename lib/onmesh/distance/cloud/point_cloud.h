// The patch as a point cloud: oriented points with normals, and who is adjacent to whom.
#pragma once

#include <vector>

#include "onmesh/mesh/triangle_mesh.h"
#include "onmesh/nodes/node_mesh.h"
#include "onmesh/patches/patch.h"

namespace onmesh::cloud {

/// Whether a triangle with these side lengths has a plane, whatever its size.
bool has_area(const std::array<double, 3>& lengths);

/// What the whole node mesh gives to every patch: where its nodes lie in space.
struct NodeGeometry {
  std::vector<Vec3> positions;
  /// Normal of the input face that the node lies inside; zero on edges and vertices.
  std::vector<Vec3> face_normals;
  /// Nodes around which no face has area: no distance leads there.
  Index skipped = 0;
};
/// \pre the nodes lie on the mesh
NodeGeometry make_node_geometry(const TriangleMesh& mesh, const NodeMesh& nodes);

/// A neighbour of a point.
struct Spoke {
  Index point = 0;
  int turn = 1;        ///< -1 if the two points' normals lie on different sides of the surface
  Index face = kNone;  ///< patch face between this spoke and the next; kNone after the last
  double length = 0;   ///< of the patch's edge to that point
};

/// The points of a patch. A node is one point for each fan of faces around it that manifold edges
/// hold together: where several sheets meet (the spine of a book, a bow tie) there are several
/// points at one place, each with the normal of its own sheet.
struct PointCloud {
  std::vector<Index> node;             ///< per point: local node
  std::vector<Vec3> position, normal;  ///< unit; zero if the faces around the point have none
  /// The surface is flat around the point, so that it lies in the plane of its normal.
  std::vector<unsigned char> is_flat;
  std::vector<unsigned char> is_closed;  ///< the fan goes all the way round
  std::vector<Index> offsets;            ///< CSR of spokes
  /// Neighbours counter-clockwise around the normal. If the fan is open, the first and the last are
  /// joined to the point by border edges: of the surface, of the patch, or with three or more
  /// faces.
  std::vector<Spoke> spokes;

  Index size() const { return Index(node.size()); }
};
/// \param geometry of the node mesh that the patch was cut from
PointCloud make_point_cloud(const Patch& patch, const NodeGeometry& geometry);

/// A neighbour as a point sees it: where it comes to lie when the surface between the two is
/// flattened into the point's tangent plane.
struct Sight {
  Vec3 offset = Vec3::Zero();  ///< in the plane
  double length = 0;           ///< of the offset; the same in both directions
  bool valid = false;          ///< false if the normals are nearly opposite
};

/// Two points on flat surroundings see each other over the crease in which their planes meet, if it
/// runs between them: the one's plane is turned about it into the other's. All others are as far as
/// the straight line is long.
/// \param turn of the other point's normal: see Spoke::turn
Sight look(const PointCloud& points, Index from, Index to, int turn);

/// The length of an edge of the cloud's triangles. Of adjacent points that of the patch's edge (a
/// sight would cut short what is folded more than once between them), else of the sight, or of the
/// straight line if there is none. The same in both directions.
/// \param turn see look()
double edge_length(const PointCloud& points, Index from, Index to, int turn);

}  // namespace onmesh::cloud
