// The first part of the filter, which plan_filter() stops after: mesh, texel map, resolved lengths.
#pragma once

#include "onmesh/atlas/overlap.h"
#include "onmesh/filter/options.h"
#include "onmesh/filter/prepare_mesh.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/working_plan.h"
#include "onmesh/nodes/refine.h"

namespace onmesh {

struct FilterSetup : PreparedMesh {
  OverlapPolicy overlap;
  WorkingPlan lengths;       ///< in working units: what the stages compute with
  RefineOptions refinement;  ///< what the nodes are made with, in working units
  bool graded = false;       ///< Poisson samples follow the size of the texels
  FilterPlan mesh_plan;      ///< in mesh units, complete: what the user is told
};

/// Check options, mesh and texture, and find out what the filter will do.
/// \throw as filter()
FilterSetup set_up_filter(const TriangleMesh& mesh, const SurfaceTextures& textures,
                          const FilterOptions& options);

}  // namespace onmesh
