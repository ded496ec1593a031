// The lengths that the filter works with.
#pragma once

#include "onmesh/filter/report.h"

namespace onmesh {

/// The lengths of a FilterPlan in working units (PreparedMesh::unit mesh units each), which the
/// stages compute with. A type of its own, so that the two cannot be taken for each other.
struct WorkingPlan {
  double sigma_spatial = 0, radius = 0;
  double node_spacing = 0, curved_spacing = 0, finest_spacing = 0;
  double sample_spacing = 0, largest_sample_spacing = 0;  ///< Poisson samples only
  double texel_size = 0, diagonal = 0;
  double bridge = 0;        ///< 0 = none
  double surface_area = 0;  ///< square working units
};

/// The plan's lengths and areas in mesh units; what else a FilterPlan tells is left to the caller.
/// \param unit mesh units per working unit
FilterPlan in_mesh_units(const WorkingPlan& plan, double unit);

}  // namespace onmesh
