// Surfaces with parts that are close in space and not on the surface, and how that shows.
#pragma once

#include <set>
#include <vector>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// A sheet folded into a U: two leaves joined by a half circle, n squares along each leaf and 4
/// around the bend, ny across; no UVs. \param leaf_of_face receives 0 and 2 for the leaves, 1 for
/// the bend
TriangleMesh u_shape(double leaf, double height, double gap, int n, int ny,
                     std::vector<int>* leaf_of_face = nullptr);

/// Three pages joined at one spine, an edge of three faces in each row; no UVs.
TriangleMesh thin_book(double page, double height, int n, int ny);

/// n triangles that share nothing but one vertex, in a cone; no UVs.
TriangleMesh pinwheel(int n);

/// Distance from the segment from a to b.
double edge_distance(const Vec3& p, const Vec3& a, const Vec3& b);

/// Faces joined to the point's face within a ball around the point, by trying all pairs of faces
/// until none is new.
std::set<Index> flood(const TriangleMesh& mesh, const SurfacePoint& from, double radius);

}  // namespace onmesh
