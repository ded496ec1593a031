// How close the filter's nodes are, and how many that makes.
#pragma once

#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/filter/working_plan.h"
#include "onmesh/nodes/refine.h"

namespace onmesh {

/// Node spacing on flat and on curved surface, and at cones, creases and corners. Lengths in the
/// unit of sigma.
struct NodeSpacing {
  double flat = 0, curved = 0, finest = 0;
};

/// The spacing rule: 1.5 sigma where the surface is curved, up to twice that where it is nearly
/// flat, a quarter of sigma where distances bend; but with enough texels per node face to keep the
/// kernel busy and tables small: 10 texels where the surface is curved.
///
/// Interpolation is exact on flat and folded surface; on curved surface squared distances d^2 are
/// off by about h^2 d^2 |K| / 12 at spacing h. The table's floats also have to tell pairs within
/// the radius from others, so spacings beyond 10 texels are at most three radii.
/// \param depends_on_spacing sigma where the surface is smooth: distances are only as good as the
///   nodes are close (heat, cloud, bridges), or the result is the distances' alone (Gaussian
///   filter)
/// \param by_nodes the sums will be done on the nodes, which therefore follow sigma down to 4
///   texels
NodeSpacing node_spacing_for(double sigma, double radius, double texel_size,
                             bool depends_on_spacing, bool by_nodes);

/// Nodes as the plan wants them, where texels are and as far around as paths between them lead.
RefineOptions refinement_for(const PreparedMesh& prepared, const WorkingPlan& plan);

}  // namespace onmesh
