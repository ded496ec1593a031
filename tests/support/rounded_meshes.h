// Meshes as files round them, so that what was one vertex becomes several.
#pragma once

#include <functional>

#include "onmesh/mesh/triangle_mesh.h"

namespace onmesh {

/// Coordinates become 32-bit floats, and some at random the next larger ones.
/// \param moved of a vertex: whether its coordinates may become the next ones
void round_to_floats(TriangleMesh& mesh, unsigned seed, const std::function<bool(Index)>& moved);

/// Loose triangles whose corners were rounded to floats each by itself.
TriangleMesh rounded_soup(const TriangleMesh& mesh, unsigned seed);

/// A rectangle in columns * rows quads from (x, y), with UVs equal to positions.
TriangleMesh rectangle(double x, double y, double width, double height, int columns, int rows);

/// Number of edges with one face.
Index count_boundary(const TriangleMesh& mesh);

/// Smallest length of an edge.
double shortest_edge(const TriangleMesh& mesh);

}  // namespace onmesh
