// The texels near each texel, over the whole surface.
#pragma once

#include <functional>
#include <span>

#include "onmesh/distance/backend.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Called with the number of a target and the texels of the samples near it, without its own. From
/// any thread; every target once.
using VisitNear = std::function<void(Index target, std::span<const Index> texels)>;

/// Visit all targets that have a radius above 0.
/// \param radius_of how far samples of a target may be, mesh units
void visit_near_texels(const NodeMesh& nodes, const DistanceBackend& backend,
                       const Samples& samples, const Samples& targets,
                       const std::function<double(const Sample&)>& radius_of,
                       const VisitNear& visit);

}  // namespace onmesh
