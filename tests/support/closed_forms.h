// Geodesic distances in closed form, on surfaces that unfold into a plane: they owe nothing to the
// library. What is returned looks at the mesh, which must outlive it.
#pragma once

#include <functional>

#include "onmesh/mesh/triangle_mesh.h"
#include "support/distances.h"

namespace onmesh {

/// Distances that follow from the positions of the two points.
Distances by_positions(const TriangleMesh& mesh,
                       std::function<double(const Vec3&, const Vec3&)> distance);

/// Straight lines through space: geodesics on a flat mesh without holes.
Distances straight_distances(const TriangleMesh& mesh);

/// On a sheet whose one chart is the sheet laid out flat, up to an affine map (folded and stretched
/// planes): the straight line there. \pre the chart is convex
Distances sheet_distances(const TriangleMesh& sheet);

/// On a cone with a sector of less than 360 degrees, from its flat chart: the shorter way around
/// the apex.
Distances cone_distances(const TriangleMesh& cone, double sector_degrees);

/// On make_book(), at any scale: any two pages unfold around the spine (the y axis) into one plane.
Distances book_distances(const TriangleMesh& book);

/// On make_moebius(): the shortest way on the unrolled double cover.
Distances moebius_distances(const TriangleMesh& strip, double length);

/// On make_bow_tie(): from one half to the other through the origin.
Distances bow_tie_distances(const TriangleMesh& tie);

}  // namespace onmesh
