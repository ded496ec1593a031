#include "onmesh/filter/working_plan.h"

namespace onmesh {

FilterPlan in_mesh_units(const WorkingPlan& plan, double unit) {
  // Names for all members: another one does not compile until it is converted here, too.
  const auto& [sigma_spatial, radius, node_spacing, curved_spacing, finest_spacing, sample_spacing,
               largest_sample_spacing, texel_size, diagonal, bridge, surface_area] = plan;
  FilterPlan out;
  out.sigma_spatial = sigma_spatial * unit;
  out.radius = radius * unit;
  out.node_spacing = node_spacing * unit;
  out.curved_spacing = curved_spacing * unit;
  out.finest_spacing = finest_spacing * unit;
  out.sample_spacing = sample_spacing * unit;
  out.largest_sample_spacing = largest_sample_spacing * unit;
  out.texel_size = texel_size * unit;
  out.diagonal = diagonal * unit;
  out.bridge = bridge * unit;
  out.surface_area = surface_area * (unit * unit);
  return out;
}

}  // namespace onmesh
