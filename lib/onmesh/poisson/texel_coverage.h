// A Poisson-disk sample in every texel (internal).
#pragma once

#include "onmesh/atlas/texel_map.h"
#include "onmesh/poisson/disk_set.h"

namespace onmesh {

/// Add a sample to every claimed texel that the set leaves out, as far from its samples as there is
/// room in the texel. Its spacing is its distance to the closest sample that it would conflict with
/// otherwise.
/// \param map of the set's mesh
/// \param ball over that mesh; copied for each thread
void hit_all_texels(const TexelMap& map, const ConnectedBall& ball, DiskSet& disks);

}  // namespace onmesh
