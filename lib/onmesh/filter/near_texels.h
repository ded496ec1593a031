// The texels near each texel, over the whole surface.
#pragma once

#include <functional>
#include <span>

#include "onmesh/distance/backend.h"
#include "onmesh/filter/face_neighbours.h"
#include "onmesh/samples/samples.h"

namespace onmesh {

/// Called with the number of a target and the texels of the samples near it, without its own. From
/// any thread; every target once.
using VisitNear = std::function<void(Index target, std::span<const Index> texels)>;

/// What is near what.
struct NearWork {
  const NodeMesh& nodes;
  const DistanceBackend& backend;
  const Samples& samples;
  const Samples& targets;
  /// Where every texel on the surface is a sample once, if it counts; null: samples are others.
  const FaceNeighbours* neighbours = nullptr;
};

/// Visit all targets that have a radius above 0. Where samples are texels and a face holds all that
/// is near, distances are those of its plane; elsewhere they come from the back end.
/// \param radius_of how far samples of a target may be, working units
void visit_near_texels(const NearWork& work, const std::function<double(const Sample&)>& radius_of,
                       const VisitNear& visit);

}  // namespace onmesh
