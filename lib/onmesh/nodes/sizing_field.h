// How fine nodes should be, from place to place: at the vertices of any triangle complex, and far
// from what needs them.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "onmesh/mesh/closest_point.h"
#include "onmesh/mesh/edge_table.h"
#include "onmesh/nodes/refine.h"

namespace onmesh {

/// In RefineOptions::least_useful: the face needs none but its vertices.
inline constexpr double kNoNodes = std::numeric_limits<double>::max();

/// \throw OptionError if a number is outside its domain, or an array has not one entry per face
void check_refine_options(const TriangleMesh& mesh, const RefineOptions& options);

/// The largest spacing that is of use at a point: options.spacing, or what options.least_useful has
/// for its face.
double largest_spacing(const RefineOptions& options, const SurfacePoint& point);

/// The spacing wanted at every vertex: options.spacing where the surface is flat, less where it is
/// curved and where distances bend, growing away from there along the mesh's edges by
/// options.growth per unit of length (Borouchaki, Hecht & Frey, Mesh gradation control, 1998).
///
/// How much distances bend at a vertex is an angle b in radians: what the angle around it differs
/// from 2 pi by; on the border, what it exceeds pi by. At a vertex that is not manifold it is read
/// off the link, the graph of the faces around it: how far the shortest cycle through a face is
/// from 2 pi, and how far the link reaches beyond pi. Pages on a straight spine have none, as any
/// two of them make a flat sheet; the tip of a bow tie, which all paths from one part to the other
/// pass, has the largest, 2 pi.
/// \return mesh units, per vertex; options.spacing at vertices without faces, kNoNodes at those
///   around which all faces with area have it
std::vector<double> wanted_spacing(const TriangleMesh& mesh, const EdgeTable& edges,
                                   const RefineOptions& options);

/// What to add to the spacing wanted at a point because nothing is needed there. Straight distances
/// in space are used: they are never longer than those on the surface or over bridges, so no place
/// within reach on the surface is left out.
class Remoteness {
 public:
  /// \pre the mesh and the options outlive this
  Remoteness(const TriangleMesh& mesh, const RefineOptions& options);

  /// \return mesh units: 0 within options.reach of a face that is needed, and then growing by
  ///   options.growth per unit of distance; never decreases by more than that towards a
  ///   neighbouring point
  double operator()(const SurfacePoint& point) const;

 private:
  const TriangleMesh& mesh_;
  const RefineOptions& options_;
  TriangleMesh needed_;                  // the faces that are needed, if others are not
  std::optional<ClosestPoint> nearest_;  // on them
};

}  // namespace onmesh
