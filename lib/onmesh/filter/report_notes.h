// What stages add to a run's report.
#pragma once

#include "onmesh/distance/backend.h"
#include "onmesh/filter/patch_loop.h"
#include "onmesh/filter/report.h"
#include "onmesh/filter/working_values.h"
#include "onmesh/mesh/clean.h"

namespace onmesh {

void note_plan(const FilterPlan& plan, FilterReport& report);
void note_backend(const DistanceBackend& backend, DistanceMethod method,
                  const CleanReport& cleaning, FilterReport& report);
void note_counts(const PatchCounts& counts, FilterReport& report);
/// \param left covered texels that have no value even so
void note_missing(const WorkingValues& working, std::uint64_t left, FilterReport& report);

}  // namespace onmesh
