// Distances from one point of a surface, with any back end, wherever they are wanted.
#pragma once

#include <vector>

#include "inputs.h"
#include "onmesh/atlas/texel_map.h"
#include "onmesh/distance/backend.h"
#include "onmesh/image/image.h"
#include "onmesh/nodes/refine.h"

namespace onmesh::tools {

/// Where distances start.
struct DistanceSource {
  SurfacePoint point;
  Index vertex = kNone;    ///< of the cleaned mesh, if the source is one
  double off_surface = 0;  ///< how far the point that was asked for lies from it
};

/// Vertex of the file, from 0.
/// \param option which names it, for messages
/// \throw UsageError if there is none or no face is left around it
DistanceSource source_at_vertex(const InputMesh& input, std::int64_t vertex, const char* option);
/// The first face whose UV triangle, moved by whole tiles, holds the UV.
/// \throw UsageError if none does
DistanceSource source_at_uv(const TriangleMesh& mesh, const Vec2& uv, const char* option);
/// The closest point of the surface.
DistanceSource source_at_point(const TriangleMesh& mesh, const Vec3& point);

/// Distance between nodes unless one is given: the mean edge, 1 % of the diagonal or a fifth of the
/// radius, whichever is least, but not so small that there would be millions of nodes.
double default_spacing(const TriangleMesh& mesh, double radius);

/// Values at the vertices of the welded mesh from those at the cleaned one's; NaN where no face is
/// left.
std::vector<double> at_welded_vertices(const InputMesh& input,
                                       const std::vector<double>& at_cleaned);

/// Distance (mesh units) per node, right up to the radius (infinity = everywhere). Beyond it may be
/// NaN, as is where no way leads.
std::vector<double> node_distances(const TriangleMesh& mesh, const NodeSurface& surface,
                                   const DistanceSource& source, DistanceMethod method,
                                   double radius);

/// Distances beyond the radius become NaN.
void forget_beyond(double radius, std::vector<double>& distances);

/// Distance at a place in a node face, interpolated so that it is right for a point straight ahead
/// in a plane; NaN if a corner's is not known.
double distance_at(const NodeMesh& nodes, const NodePoint& place,
                   const std::vector<double>& at_nodes);

/// Distance per texel (the least one where several places share it), interpolated from the nodes;
/// NaN where no chart covers it or a corner's distance is not known. One image per tile.
std::vector<Image> distance_texture(const TexelMap& map, const NodeSurface& surface,
                                    const std::vector<double>& at_nodes, double radius);
/// The same, exact.
std::vector<Image> exact_distance_texture(const TriangleMesh& mesh, const TexelMap& map,
                                          const DistanceSource& source, double radius);

}  // namespace onmesh::tools
